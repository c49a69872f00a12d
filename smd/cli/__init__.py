"""The command line: one module per command; each reads arguments, calls and prints."""
