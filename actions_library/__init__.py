"""Libraries: actions, their patterns and clips, and the character that these move."""
