"""How the shipped character and its clips are made: run once, never at play time."""
