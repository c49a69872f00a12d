from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laban import AXES, Effort
from smd.errors import ExportError, ScoreError
from smd.score import INTENTS, Alternative, Part, Phrase, Score, Suggestion
from smd.score_file import read_score, score_from_json, score_to_json, write_score

GOLDEN = Path(__file__).parents[1] / "golden" / "scores"

thousandths = st.integers(-1000, 1000).map(lambda i: i / 1000)
names = st.text(min_size=1, max_size=12).filter(str.strip)
efforts = st.builds(Effort, **{axis: st.none() | thousandths for axis in AXES})
costs = st.integers(0, 99_000).map(lambda i: i / 1000)
alternatives = st.builds(Alternative, names, costs, st.none() | costs, st.text(max_size=12))


@st.composite
def parts(draw: st.DrawFn, device: str) -> Part:
    cuts = draw(st.lists(st.integers(-5_000, 3_600_000), unique=True, max_size=8))
    cuts.sort()
    phrases, suggestions = [], []
    for start, end in zip(cuts[::2], cuts[1::2], strict=False):
        others = tuple(draw(st.lists(alternatives, max_size=3)))
        if others and draw(st.booleans()):
            # The first of them is named in the file, and read back as the first of its name.
            suggestions.append(Suggestion(start / 1000, end / 1000, others))
            continue
        phrase = Phrase(
            draw(names),
            start / 1000,
            end / 1000,
            draw(efforts),
            draw(st.integers(0, 1000)) / 1000,
            others,
            draw(st.booleans()),
        )
        phrases.append(phrase)
    intent = draw(st.sampled_from(("", *INTENTS)))
    return Part(device, tuple(phrases), draw(st.text(max_size=5)), intent, tuple(suggestions))


@st.composite
def scores(draw: st.DrawFn) -> Score:
    devices = draw(st.lists(names, unique=True, max_size=3))
    return Score(
        tuple(draw(parts(device)) for device in devices),
        recording=draw(st.text(max_size=12)),
        library=draw(st.text(max_size=12)),
        figure_height_m=draw(st.floats(1e-3, 1e3)),
        reading=tuple(draw(st.dictionaries(st.text(max_size=5), st.text(max_size=5))).items()),
        warnings=tuple(draw(st.lists(st.text(max_size=20), max_size=3))),
    )


@given(scores())
def test_a_score_comes_back_from_its_json_as_it_was(score):
    assert score_from_json(score_to_json(score)) == score


@given(scores())
def test_a_score_comes_back_from_its_file_as_it_was(tmp_path_factory, score):
    path = tmp_path_factory.mktemp("score") / "take.score.json"
    write_score(score, path)
    assert read_score(path) == score


@given(st.recursive(st.none() | st.booleans() | st.floats() | st.text(), st.lists))
def test_any_other_json_is_refused_in_one_line(value):
    with pytest.raises(ScoreError) as caught:
        score_from_json(json.dumps(value), "take.json")
    assert str(caught.value).startswith("take.json: ")
    assert "\n" not in str(caught.value)


WALK = Phrase("walk", 0.5, 2.25, Effort(time=-0.5, weight=0.25), 0.875)
PUNCH = Phrase("punch", 2.25, 3.0, Effort(), 0.5, (Alternative("throw", 1.5),))
GOES_ALONG = Phrase("walk", 3.0, 6.0, confidence=0.0, implied=True)
WAVES = Suggestion(3.5, 5.25, (Alternative("wave", 12.5, 10.25, "too slow"),))


def told(*performers: Part) -> Score:
    return Score(performers, "take.csv", reading=(("up", "z"),))


def story() -> Score:
    fox = Part("fox", (WALK, PUNCH, GOES_ALONG), intent="free", suggestions=(WAVES,))
    return told(fox, Part("wolf"))


def test_a_golden_score_of_version_1_still_reads():
    read = read_score(GOLDEN / "version_1.score.json")
    assert read == told(Part("fox", (WALK, PUNCH)), Part("wolf"))


def test_a_golden_score_of_version_2_reads():
    assert read_score(GOLDEN / "version_2.score.json") == story()


def test_a_score_is_written_as_the_golden_one():
    golden = (GOLDEN / "version_2.score.json").read_text(encoding="utf-8")
    assert score_to_json(story()) == golden


def moved_over(text: str, *, leave: bool = False) -> str:
    """Return a Score's text with the line of its suggestion among its phrases, the last one."""
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if '"suggestions"' in line) + 1
    line = lines[at]
    assert '"wave"' in line
    if not leave:
        del lines[at]
    lines[at - 2] += ","
    return "\n".join([*lines[: at - 1], line, *lines[at - 1 :]])


def test_a_suggestion_is_a_phrase_once_its_line_is_moved_and_what_is_implied_gives_way():
    fox, _ = score_from_json(moved_over(score_to_json(story()))).performers
    before, after = replace(GOES_ALONG, end_s=3.5), replace(GOES_ALONG, start_s=5.25)
    assert fox.phrases == (WALK, PUNCH, before, WAVES.accepted(), after)
    assert fox.suggestions == ()


def test_a_suggestion_that_was_copied_and_not_moved_is_refused():
    with pytest.raises(ScoreError) as caught:
        score_from_json(moved_over(score_to_json(story()), leave=True), "take.json")
    assert str(caught.value) == (
        "take.json: performers[0].suggestions[0]: expected movement that no phrase explains: move "
        'a suggestion over, do not copy it, found 3.5 to 5.25 s, which is in the phrase "wave" '
        "at 3.5 s"
    )


def test_a_suggestion_that_was_accepted_twice_is_refused():
    once = moved_over(score_to_json(story()), leave=True)
    with pytest.raises(ScoreError, match=r"phrases\[4\].start_s: expected 5.25 or later, the end"):
        score_from_json(moved_over(once), "take.json")


def test_phrases_may_stand_in_any_order():
    score = told(Part("fox", (WALK, PUNCH)))
    whole = json.loads(score_to_json(score))
    whole["performers"][0]["phrases"].reverse()
    assert score_from_json(json.dumps(whole)) == score


def test_a_suggestion_named_otherwise_by_hand_has_that_action_first():
    both = Suggestion(1.0, 2.0, (Alternative("wave", 2.0), Alternative("clap", 3.0)))
    whole = json.loads(score_to_json(told(Part("fox", suggestions=(both,)))))
    whole["performers"][0]["suggestions"][0]["action"] = "clap"
    (read,) = score_from_json(json.dumps(whole)).performers
    assert read.suggestions == (replace(both, likeliest=both.likeliest[::-1]),)


def test_suggestions_of_all_performers_are_seen_together():
    other = replace(WAVES, start_s=0.0, end_s=1.0)
    score = told(Part("fox", suggestions=(other, WAVES)), Part("wolf", suggestions=(other,)))
    assert score.suggestions == (("fox", other), ("fox", WAVES), ("wolf", other))


@pytest.mark.parametrize(
    ("part", "message"),
    [
        ({"intent": "maybe"}, "intent: expected drawn or free, got 'maybe'"),
        ({"suggestions": (WAVES, WAVES)}, "suggestion at 3.5 s starts before the one before"),
        (
            {"phrases": (replace(PUNCH, end_s=4.0),), "suggestions": (WAVES,)},
            "suggestion at 3.5 s overlaps the phrase 'punch' at 2.25 s",
        ),
    ],
)
def test_a_part_refuses_what_does_not_go_together(part, message):
    with pytest.raises(ScoreError, match=message):
        Part("fox", **part)


@pytest.mark.parametrize("likeliest", [(), (Alternative("wave", 1.0),)])
def test_a_suggestion_has_an_action_and_a_length(likeliest):
    with pytest.raises(ScoreError, match="suggestion at 1 s: expected"):
        Suggestion(1.0, 1.0 if likeliest else 2.0, likeliest)


@given(st.floats(0.9, 1.1), st.floats(1e-4, 0.1), st.floats(0.0, 9e-10))
def test_rounding_makes_no_suggestion_overlap_a_phrase(end_s, length_s, into_s):
    start_s = end_s - into_s
    whole = Suggestion(start_s, start_s + length_s, WAVES.likeliest)
    after = Phrase("bow", whole.end_s - into_s, 2.0)
    part = Part("a", (Phrase("walk", 0.0, end_s), after), suggestions=(whole,))
    (read,) = score_from_json(score_to_json(Score((part,)))).performers
    assert len(read.suggestions) <= 1


def test_times_are_written_with_three_decimals_and_a_phrase_a_line():
    lines = score_to_json(story()).splitlines()
    walk = next(line for line in lines if '"walk"' in line)
    assert '"start_s": 0.500, "end_s": 2.250' in walk
    assert not any('"walk"' in line and '"punch"' in line for line in lines)


def test_effort_axes_that_were_not_read_are_left_out():
    score = Score((Part("a", (Phrase("bow", 0.0, 1.0, Effort(weight=0.5)),)),))
    (phrase,) = json.loads(score_to_json(score))["performers"][0]["phrases"]
    assert phrase["effort"] == {"weight": 0.5}


def test_a_score_written_by_hand_needs_only_devices_actions_and_times():
    text = """{"schema": "smd.score", "version": 1, "performers": [
        {"device": "fox", "phrases": [{"action": "walk", "start_s": 1, "end_s": 2}]}]}"""
    assert score_from_json(text) == Score((Part("fox", (Phrase("walk", 1.0, 2.0),)),))


def test_rounding_makes_no_phrases_overlap():
    part = Part("a", (Phrase("walk", 0.0, 1.0005), Phrase("run", 1.0005 - 9e-10, 2.0)))
    (read,) = score_from_json(score_to_json(Score((part,)))).performers
    assert read.phrases[1].start_s == read.phrases[0].end_s


def test_a_phrase_too_short_for_three_decimals_is_not_written():
    score = Score((Part("a", (Phrase("walk", 1.0, 1.0001),)),))
    with pytest.raises(ScoreError, match=r"'walk' at 1 s: expected to last at least 0\.001 s"):
        score_to_json(score)


def minimal() -> dict:
    phrases = [
        {"action": "walk", "start_s": 0.0, "end_s": 1.0, "effort": {"time": 0.5}},
        {"action": "bow", "start_s": 1.5, "end_s": 2.0, "alternatives": []},
    ]
    return {
        "schema": "smd.score",
        "version": 1,
        "performers": [{"device": "fox", "phrases": phrases}],
    }


DROP = object()
WAVING = {"action": "wave", "distance": 2.0}

FAULTS = [
    (
        ["performers", 0, "intent"],
        "meant",
        'performers[0].intent: expected "drawn" or "free", found "meant"',
    ),
    (
        ["performers", 0, "phrases", 1, "implied"],
        1,
        "performers[0].phrases[1].implied: expected true or false, found 1",
    ),
    (
        ["performers", 0, "suggestions"],
        [{"action": "wave", "start_s": 3, "end_s": 4}],
        'performers[0].suggestions[0].action: expected one of its alternatives, found "wave"',
    ),
    (
        ["performers", 0, "suggestions"],
        2 * [{"action": "wave", "start_s": 3, "end_s": 4, "alternatives": [WAVING]}],
        "performers[0].suggestions[1].start_s: expected 4 or later, the end of the suggestion "
        "before, found 3",
    ),
    (["schema"], DROP, 'take.json: expected the schema "smd.score", found none'),
    (["schema"], "smd.library", 'expected the schema "smd.score", found "smd.library"'),
    (["version"], DROP, "version: expected the number 2, found none"),
    (["version"], True, "version: expected the number 2, found true"),
    (["version"], "1", 'version: expected the number 2, found "1"'),
    (["version"], 3, "version: expected 2, the newest this release reads, found the newer 3"),
    (["performers"], DROP, 'take.json: expected the key "performers", found none'),
    (["performers"], {}, "performers: expected a list, found an object"),
    (["performer"], [], 'expected the key "performers", found the unknown key "performer"'),
    (["library"], 3, "library: expected text in quotes, found 3"),
    (["reading"], [], "reading: expected an object, found a list"),
    (["reading"], {"up": 1}, "reading.up: expected text in quotes, found 1"),
    (["warnings"], "beware", 'warnings: expected a list, found "beware"'),
    (["warnings"], ["ok", None], "warnings[1]: expected text in quotes, found null"),
    (["figure_height_m"], 0, "figure_height_m: expected a positive number, found 0"),
    (["figure_height_m"], float("nan"), "figure_height_m: expected a finite number, found NaN"),
    (["figure_height_m"], 10**400, "figure_height_m: expected a finite number, found 1000"),
    (["performers", 0], "fox", 'performers[0]: expected an object, found "fox"'),
    (["performers", 0, "device"], " ", 'performers[0].device: expected a name, found " "'),
    (["performers", 0, "phrases"], DROP, 'performers[0]: expected the key "phrases", found none'),
    (
        ["performers", 0, "phrases", 1, "action"],
        7,
        "performers[0].phrases[1].action: expected text in quotes, found 7",
    ),
    (
        ["performers", 0, "phrases", 1, "start_s"],
        "1.5",
        'performers[0].phrases[1].start_s: expected a number, found "1.5"',
    ),
    (
        ["performers", 0, "phrases", 1, "start_s"],
        False,
        "performers[0].phrases[1].start_s: expected a number, found false",
    ),
    (
        ["performers", 0, "phrases", 1, "start_s"],
        float("inf"),
        "performers[0].phrases[1].start_s: expected a finite number, found Infinity",
    ),
    (
        ["performers", 0, "phrases", 1, "start_s"],
        0.75,
        "performers[0].phrases[1].start_s: expected 1 or later, the end of the phrase before, "
        "found 0.75",
    ),
    (
        ["performers", 0, "phrases", 1, "end_s"],
        1.5,
        "performers[0].phrases[1].end_s: expected more than 1.5, its start_s, found 1.5",
    ),
    (
        ["performers", 0, "phrases", 1, "confidence"],
        1.5,
        "performers[0].phrases[1].confidence: expected a number in [0, 1], found 1.5",
    ),
    (
        ["performers", 0, "phrases", 0, "effort", "time"],
        -2,
        "performers[0].phrases[0].effort.time: expected a number in [-1, 1], found -2",
    ),
    (
        ["performers", 0, "phrases", 0, "effort", "wait"],
        0,
        'performers[0].phrases[0].effort: expected the key "weight", found the unknown key "wait"',
    ),
    (
        ["performers", 0, "phrases", 1, "alternatives"],
        [{"action": "fly"}],
        'performers[0].phrases[1].alternatives[0]: expected the key "distance", found none',
    ),
    (
        ["performers", 0, "phrases", 1, "stars"],
        5,
        'performers[0].phrases[1]: expected the key "start_s", found the unknown key "stars"',
    ),
]


@pytest.mark.parametrize(("path", "value", "message"), FAULTS)
def test_a_fault_is_named_by_its_place_with_what_was_expected_and_found(path, value, message):
    whole = minimal()
    place = whole
    for key in path[:-1]:
        place = place[key]
    if value is DROP:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    with pytest.raises(ScoreError) as caught:
        score_from_json(json.dumps(whole), "take.json")
    assert message in str(caught.value)
    assert str(caught.value).startswith("take.json: ")
    assert "\n" not in str(caught.value)


def test_a_device_that_appears_twice_is_refused():
    whole = minimal()
    whole["performers"] *= 2
    with pytest.raises(ScoreError, match=r"performers\[1\]: expected each device once"):
        score_from_json(json.dumps(whole))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1, column 1: expected JSON"),
        ("{\n  oops\n}", "line 2, column 3: expected JSON"),
        ("[" * 100_000, "nested too deeply"),
        ("[" * 100_000 + "]" * 100_000, "nested too deeply"),
        ('{"schema": "smd.score", "schema": "smd.score"}', 'the key "schema" twice'),
        ("9" * 5000, "expected JSON, found "),
        ("[]", "expected an object, found a list"),
    ],
)
def test_text_that_is_no_score_is_refused(text, message):
    with pytest.raises(ScoreError) as caught:
        score_from_json(text, "take.json")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32"])
def test_a_file_that_is_not_utf_8_is_refused(tmp_path, encoding):
    path = tmp_path / "take.json"
    path.write_bytes(score_to_json(story()).encode(encoding))
    with pytest.raises(ScoreError, match=r"take\.json: expected UTF-8 text"):
        read_score(path)


def test_a_byte_order_mark_does_no_harm(tmp_path):
    path = tmp_path / "take.json"
    path.write_bytes(score_to_json(story()).encode("utf-8-sig"))
    assert read_score(path) == story()


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    with pytest.raises(ScoreError, match=r"none\.json: expected a Score file, found none"):
        read_score(tmp_path / "none.json")
    with pytest.raises(ScoreError, match="expected a Score file, found a folder"):
        read_score(tmp_path)


def test_a_score_that_cannot_be_written_leaves_the_old_one(tmp_path):
    path = tmp_path / "take.json"
    write_score(story(), path)
    before = path.read_bytes()
    with pytest.raises(ScoreError):
        write_score(Score((Part("a", (Phrase("walk", 1.0, 1.0001),)),)), path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_does_not_exist_is_named(tmp_path):
    with pytest.raises(ExportError, match="expected an existing folder"):
        write_score(story(), tmp_path / "nowhere" / "take.json")


def test_a_name_that_is_no_unicode_comes_back_as_it_was(tmp_path):
    score = Score((), recording="take-\udcff.csv")
    write_score(score, tmp_path / "take.json")
    assert read_score(tmp_path / "take.json") == score
