from __future__ import annotations

from actions_library.folder import load_library
from actions_library.gestures import with_gestures
from smd.recognition.action import Action

ACTIONS = (
    Action("walk", None, travels=True, cyclic=True),
    Action("sit_down", None),
    Action("idle", None, cyclic=True),
    Action("purr", None, description="Not drawn."),
)


def test_an_action_is_drawn_as_the_lenders_of_its_name():
    lender = load_library()
    walk = with_gestures(ACTIONS, lender)[0]
    theirs = lender.action("walk")
    assert (walk.pattern, walk.description) == (theirs.pattern, theirs.description)
    assert walk.exemplar is theirs.exemplar


def test_what_the_clip_decides_stays():
    _, sit_down, *_ = with_gestures(ACTIONS, load_library())
    assert load_library().action("sit_down").rest == "idle_sitting"
    assert sit_down.rest == ""


def test_what_the_lender_does_not_draw_stays_as_it_is():
    assert with_gestures(ACTIONS, load_library())[2:] == ACTIONS[2:]
