"""A fault says what is wrong and where; the door adds which file, in its own error."""

from __future__ import annotations

from pathlib import Path

import pytest

from laban.faults import Fault, naming


class DoorError(Exception):
    pass


def test_the_door_names_the_file_and_nothing_else_of_a_fault():
    with pytest.raises(DoorError) as caught, naming(Path("a") / "b.txt", DoorError):
        raise Fault("line 3", "a number", "'x'")
    assert str(caught.value) == f"{Path('a') / 'b.txt'}: line 3: expected a number, found 'x'"


def test_the_whole_of_a_file_has_no_place():
    assert (
        str(Fault("", "rows", "none").of("b.txt", DoorError)) == "b.txt: expected rows, found none"
    )
    assert str(Fault("", "rows", "none")) == "expected rows, found none"


def test_what_others_have_put_into_words_is_left_as_it_is():
    fault = Fault.saying("row 2", "pattern 'T_': expected a token")
    assert str(fault.of("b.txt", DoorError)) == "b.txt: row 2: pattern 'T_': expected a token"


def test_a_message_is_one_line_whatever_was_found():
    fault = Fault("line 3", "a name", "a\nb\x1b[2J")
    assert str(fault.of("b.txt", DoorError)) == "b.txt: line 3: expected a name, found a_b_[2J"


def test_what_is_no_fault_passes_as_it_is_and_causes_are_kept():
    with pytest.raises(ValueError, match="not of the file"), naming("b.txt", DoorError):
        raise ValueError("not of the file")
    with pytest.raises(DoorError) as caught, naming("b.txt", DoorError):
        try:
            raise OSError("why")
        except OSError as error:
            raise Fault("", "a file", "none") from error
    assert isinstance(caught.value.__cause__, OSError)
