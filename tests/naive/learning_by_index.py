"""The paper's learning (section 4.3) to the letter: mandatory tokens paired by their index.

It stands here to be compared with; an example with one token more shifts all that follow.
"""

from __future__ import annotations

from smd.recognition import pattern as ast
from smd.recognition.pattern import Pattern


def learned_by_index(sequences, is_mandatory):
    """Return the pattern of token sequences; ``is_mandatory`` has a truth value for each token."""
    mandatory = [
        [t for t, m in zip(*pair, strict=True) if m]
        for pair in zip(sequences, is_mandatory, strict=True)
    ]
    shortest = min(map(len, mandatory))
    parts = []
    for index in range(max(map(len, mandatory)) + 1):
        before = [
            optional_before(*pair, index) for pair in zip(sequences, is_mandatory, strict=True)
        ]
        options = tuple(dict.fromkeys(_sequence(tokens) for tokens in before if tokens))
        if options:
            # Equal everywhere: a quick intentional gesture.
            meant = len(options) == 1 and all(before)
            parts.append(options[0] if meant else ast.Repeat(ast.Choice(options), True))
        here = tuple(dict.fromkeys(m[index] for m in mandatory if index < len(m)))
        if here:
            parts.append(ast.Repeat(ast.Choice(here), optional=index >= shortest))
    return Pattern(ast.Sequence(tuple(parts)))


def optional_before(sequence, is_mandatory, index):
    """Return the optional tokens between mandatory tokens ``index - 1`` and ``index``."""
    passed, found = 0, []
    for token, mandatory in zip(sequence, is_mandatory, strict=True):
        if mandatory:
            passed += 1
        elif passed == index:
            found.append(token)
    return found


def _sequence(tokens):
    return tokens[0] if len(tokens) == 1 else ast.Sequence(tuple(tokens))
