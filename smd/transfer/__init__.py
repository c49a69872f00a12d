"""From a Score to a Performance: path, clips, timing, transitions, contacts."""
