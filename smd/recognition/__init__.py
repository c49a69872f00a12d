"""From a doodle to spans of actions: tokens, patterns, automata, segmentation."""
