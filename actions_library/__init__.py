"""What can be performed: actions, their patterns and clips, and the character they move."""
