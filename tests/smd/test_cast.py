"""Each performer acts with its own library, or with that of all."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from actions_library.folder import load_library
from smd.cast import Cast, cast_of
from smd.errors import LibraryError
from smd.formats import read_recording
from smd.pipeline import animate, parse

STORIES = Path(__file__).parents[2] / "recordings"


@pytest.fixture(scope="module")
def library():
    return load_library()


@pytest.fixture(scope="module")
def duel():
    return read_recording(STORIES / "duel.csv")


@pytest.fixture(scope="module")
def peaceful(library):
    """The shipped library without throwing."""
    kept = tuple(a for a in library.actions if a.name != "throw")
    names = {action.name for action in kept}
    return replace(
        library,
        actions=kept,
        clip_files={n: f for n, f in library.clip_files.items() if n in names},
        exemplar_files={n: f for n, f in library.exemplar_files.items() if n in names},
        credits={n: c for n, c in library.credits.items() if n in names},
    )


def actions_of(score, device):
    (part,) = [part for part in score.performers if part.device == device]
    return [phrase.action for phrase in part.phrases]


def test_a_library_alone_is_a_cast_in_which_all_share_it(library):
    assert cast_of(library).of("anyone") is library
    cast = Cast(library, {"fox": library})
    assert cast_of(cast) is cast


def test_each_device_is_acted_with_its_own_library_and_idles_through_what_it_lacks(
    library, peaceful, duel
):
    shared = parse(duel, library)
    cast = Cast(library, {"rival": peaceful})
    score = parse(duel, cast)
    assert score.performers[0] == shared.performers[0]
    # who draws for the rival may throw all the same, and it is called by its name
    assert actions_of(score, "rival") == actions_of(shared, "rival")
    performance = animate(score, duel, cast)
    assert [a.character for a in performance.actors] == [library.character, peaceful.character]
    (line,) = [line for line in performance.warnings if "no such action" in line]
    assert line.startswith("device 'rival': 'throw' at ") and line.endswith("and idles")
    rival = performance.actors[1]
    assert "throw" not in [phrase.action for phrase in rival.phrases]


def test_what_a_library_explains_is_not_explained_by_another(library, duel):
    # the same gesture by another name: it is the own one's
    own = replace(
        library,
        actions=tuple(
            replace(a, name="strike") if a.name == "punch" else a for a in library.actions
        ),
        clip_files={("strike" if n == "punch" else n): f for n, f in library.clip_files.items()},
        exemplar_files={
            ("strike" if n == "punch" else n): f for n, f in library.exemplar_files.items()
        },
        credits={("strike" if n == "punch" else n): c for n, c in library.credits.items()},
    )
    score = parse(duel, Cast(library, {"knight": own}))
    as_shared = actions_of(parse(duel, library), "knight")
    assert "punch" in as_shared
    assert actions_of(score, "knight") == [
        "strike" if name == "punch" else name for name in as_shared
    ]


def test_a_library_for_nobody_is_refused(library, duel):
    cast = Cast(library, {"knigth": library})
    for use in (lambda: parse(duel, cast), lambda: animate(parse(duel, library), duel, cast)):
        with pytest.raises(LibraryError, match=r"expected devices .*\(knight, rival\), found 'kn"):
            use()
