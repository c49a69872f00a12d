from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actions_library.authoring.actions import HUMANOID_ACTIONS
from smd.doodle import Doodle
from smd.recognition.costs import DEFAULT_COSTS
from smd.recognition.pattern import Pattern
from smd.recognition.token_spotter import recognize
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, Token, TokenRun
from smd.smoothing import smooth
from smd.synthetic.efforts import ACTIONS
from smd.synthetic.person import STEADY, simulated_person
from smd.synthetic.takes import Take

# Those that tokens alone tell apart; tests of the whole library verify.
PATTERNS = {a.name: a.pattern for a in HUMANOID_ACTIONS if a.name in ACTIONS}
FEW = {
    "walk": Pattern.parse("T_Z"),
    "punch": Pattern.parse("T_Z T_N_Z"),
    "turn": Pattern.parse("R_Y"),
    "wave": Pattern.parse("T_X T_N_X T_X"),
    "square": Pattern.parse("T_X T_Y T_N_X T_N_Y T_X"),
}


def runs_of(*what):
    """Runs of (token, extent) pairs that last 0.3 s each; of stillness, the number is seconds."""
    runs, now_s = [], 0.0
    for i, (name, amount) in enumerate(what):
        token = Token.parse(name)
        end_s = now_s + (amount if token == STILL else 0.3)
        travel = amount if token != STILL else 0.0
        runs.append(TokenRun(token, 18 * i, 18 * i + 18, now_s, end_s, travel_heights=travel))
        now_s = end_s
    return tuple(runs)


def actions(runs, patterns=FEW):
    return [span.action for span in recognize(runs, patterns)]


def scaled(doodle, factor):
    return Doodle(doodle.time_s, factor * doodle.position_m, doodle.orientation_xyzw, doodle.device)


def gesture_of(action, person, rng):
    take = Take(person, rng, heading_rad=rng.uniform(-np.pi, np.pi))
    take.pause(0.6).play(action).pause(0.6)
    return take.doodle(), take.phrases[0]


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("action", ACTIONS)
def test_a_steady_hand_is_understood_at_any_size(action, factor):
    doodle, meant = gesture_of(action, STEADY, np.random.default_rng(0))
    (span,) = recognize(tokenize(smooth(scaled(doodle, factor))), PATTERNS)
    assert span.action == action
    assert abs(span.start_s - meant.start_s) < 0.1
    assert abs(span.end_s - meant.end_s) < 0.1


def test_simulated_people_are_understood():
    understood = 0
    for seed in range(12):
        rng = np.random.default_rng([5, seed])
        person = simulated_person(rng)
        for action in ACTIONS:
            doodle, _ = gesture_of(action, person, rng)
            understood += actions(tokenize(smooth(doodle)), PATTERNS) == [action]
    assert understood >= 0.97 * 12 * len(ACTIONS)


def test_stillness_is_nothing():
    assert recognize((), PATTERNS) == ()
    assert recognize(runs_of(("STILL", 5.0)), PATTERNS) == ()


def test_aimless_movement_is_nothing():
    aimless = runs_of(("T_Y/R_X", 0.5), ("T_X_Y/R_Z", 0.4), ("R_Z", 0.6), ("T_N_Y/R_Z", 1.0))
    assert recognize(aimless, PATTERNS) == ()


def test_a_little_movement_is_nothing():
    needed = DEFAULT_COSTS.worth * DEFAULT_COSTS.action / DEFAULT_COSTS.unexplained
    assert actions(runs_of(("T_Z", 0.95 * needed))) == []
    assert actions(runs_of(("T_Z", 1.05 * needed))) == ["walk"]


def test_a_pause_parts_two_walks_and_a_moment_does_not():
    pause_s = DEFAULT_COSTS.pause_s
    assert actions(runs_of(("T_Z", 2.0), ("STILL", 1.1 * pause_s), ("T_Z", 2.0))) == ["walk"] * 2
    assert actions(runs_of(("T_Z", 2.0), ("STILL", 0.9 * pause_s), ("T_Z", 2.0))) == ["walk"]


def test_a_gesture_may_be_held_half_way():
    held = runs_of(("R_X", 1.0), ("STILL", 1.1), ("R_N_X", 1.0))
    (span,) = recognize(held, PATTERNS)
    assert (span.action, span.first_run, span.last_run) == ("bow", 0, 3)
    assert actions(runs_of(("R_X", 1.0), ("STILL", 1.3), ("R_N_X", 1.0)), PATTERNS) == []


def test_a_slip_within_a_walk_does_not_part_it():
    (span,) = recognize(runs_of(("T_Z", 2.0), ("T_X_Y", 0.1), ("T_Z", 2.0)), FEW)
    assert (span.first_run, span.last_run) == (0, 3)


def test_the_rebound_of_a_walk_is_not_a_punch():
    assert actions(runs_of(("T_Z", 2.0), ("T_N_Z", 0.08))) == ["walk"]
    assert actions(runs_of(("T_Z", 2.0), ("STILL", 0.05), ("T_N_Z", 0.08))) == ["walk"]
    assert actions(runs_of(("T_Z", 1.0), ("T_N_Z", 0.9))) == ["punch"]


def test_an_action_does_not_reach_over_other_movement():
    between = [("T_Y/R_X", 1.0), ("T_X/R_Z", 1.0), ("T_Y/R_Z", 1.0)]
    assert "punch" not in actions(runs_of(("T_Z", 1.0), *between, ("T_N_Z", 1.0)))


def test_one_wrong_stroke_among_many_is_forgiven():
    rung = [("T_X", 1.0), ("T_N_X", 1.0), ("T_X_Y", 1.0)]
    (span,) = recognize(runs_of(*rung), FEW)
    assert (span.action, span.distance) == ("wave", 1.0)


def test_an_action_does_not_stretch_over_the_rest_beside_it():
    square = [("T_X", 1.0), ("T_Y", 1.0), ("T_N_X", 1.0), ("T_N_Y", 1.0), ("T_X", 1.0)]
    rest = ("STILL", 2.0)
    for what in ([rest, *square[1:]], [*square[:-1], rest]):
        (span,) = recognize(runs_of(*what), FEW)
        assert (span.action, span.distance) == ("square", 1.0)
        assert span.last_run - span.first_run == 4


def test_small_runs_that_lead_into_an_action_belong_to_it():
    setting_out = runs_of(("STILL", 1.0), ("T_Y_Z", 0.03), ("T_Z", 2.0), ("T_N_Y_Z", 0.03))
    (span,) = recognize(setting_out, FEW)
    assert (span.first_run, span.last_run) == (1, 4)
    (span,) = recognize(runs_of(("T_X", 0.03), ("T_Z", 2.0), ("T_N_Z", 0.03)), FEW)
    assert (span.first_run, span.last_run) == (1, 2)


def test_alternatives_are_the_other_actions_nearest_first():
    (span,) = recognize(runs_of(("T_Z", 1.0), ("T_N_Z", 1.0)), FEW)
    assert span.distance == 0.0
    assert sorted(name for name, _ in span.alternatives) == ["square", "turn", "walk", "wave"]
    distances = [distance for _, distance in span.alternatives]
    assert distances == sorted(distances)
    assert span.alternatives[0] == ("walk", 1.0)


def test_confidence_falls_with_distance_and_with_rivals():
    (clear,) = recognize(runs_of(("T_Z", 1.0), ("T_N_Z", 1.0)), FEW)
    (faint,) = recognize(runs_of(("T_Z", 0.3), ("T_N_Z", 0.3)), FEW)
    (held,) = recognize(runs_of(("T_Z", 1.0), ("STILL", 0.5), ("T_N_Z", 1.0)), FEW)
    rivals = {**FEW, "poke": Pattern.parse("T_Z T_N_Z T_Z*")}
    (contested,) = recognize(runs_of(("T_Z", 1.0), ("T_N_Z", 1.0)), rivals)
    assert clear.confidence > max(faint.confidence, held.confidence, contested.confidence)
    assert contested.confidence < 0.5
    assert contested.alternatives[0] == ("poke", 0.0)


run_lists = st.lists(
    st.tuples(
        st.sampled_from(["STILL", "T_Z", "T_N_Z", "T_X", "T_N_X", "R_Y", "T_Y", "T_Z/R_Y"]),
        st.floats(0.01, 3.0),
    ),
    max_size=14,
)


@settings(deadline=None)
@given(run_lists)
def test_spans_are_in_order_and_begin_and_end_with_movement(what):
    runs = runs_of(*what)
    spans = recognize(runs, FEW)
    for before, after in pairwise(spans):
        assert before.last_run <= after.first_run
    for span in spans:
        assert runs[span.first_run].token != STILL
        assert runs[span.last_run - 1].token != STILL
        assert span.start_s == runs[span.first_run].start_s
        assert span.end_s == runs[span.last_run - 1].end_s
        assert 0.0 <= span.confidence <= 1.0
        assert span.distance >= 0.0


@pytest.mark.parametrize("seed", range(3))
def test_where_the_user_stands_and_faces_changes_nothing(seed):
    spans = []
    for heading_rad, start_m in ((0.3, (0.0, 0.8, 0.0)), (2.1, (3.0, 1.2, -7.0))):
        rng = np.random.default_rng(seed)
        take = Take(simulated_person(rng), rng, heading_rad=heading_rad, start_m=start_m)
        for action in ACTIONS:
            take.pause(0.6).play(action)
        spans.append(recognize(tokenize(smooth(take.pause(0.6).doodle())), PATTERNS))
    assert [s.action for s in spans[0]] == [s.action for s in spans[1]]
    assert [s.start_s for s in spans[0]] == pytest.approx([s.start_s for s in spans[1]], abs=0.02)


def test_idle_hands_are_mostly_left_alone(shared_data):
    from smd.formats import SourceFrame, read_recording

    spans = minutes = 0.0
    for path in sorted((shared_data / "idle").glob("*.csv"))[:6]:
        for doodle in read_recording(path, SourceFrame(handedness="left")).doodles:
            if doodle.duration_s > 0.2:
                minutes += doodle.duration_s / 60.0
                spans += len(recognize(tokenize(smooth(doodle)), PATTERNS))
    assert minutes > 2.0
    assert spans / minutes < 10.0
