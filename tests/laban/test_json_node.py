"""JSON that knows its place: whatever is wrong, the fault says where."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laban.faults import Fault
from laban.json_node import Node, parse_json, read_json, shown

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
)


def walked(node: Node):
    """The value again, by way of every member and item."""
    if isinstance(node.value, dict):
        return {key: walked(member) for key, member in node.options().items()}
    if isinstance(node.value, list):
        return [walked(item) for item in node.items()]
    return node.value


@given(VALUES)
def test_every_value_is_reached_and_shown_on_one_line(value):
    text = json.dumps(value)
    for form in (text, text.encode(), b"\xef\xbb\xbf" + text.encode()):
        assert walked(parse_json(form)) == json.loads(text)
    assert shown(value).isprintable() and len(shown(value)) <= 60


def test_a_place_reads_as_one_would_write_it():
    node = parse_json('{"a": {"b": [1, {"c": true}]}}')
    (_, last) = node.member("a").member("b").items()
    assert node.place == "" and last.member("c").place == "a.b[1].c"
    with pytest.raises(Fault, match=r"^a\.b\[1\]\.c: expected a number, found true$"):
        last.member("c").number()
    with pytest.raises(Fault, match=r'^a: expected the key "d", found none$'):
        node.member("a").member("d")


@pytest.mark.parametrize(
    ("method", "wrong"),
    [
        ("options", [1, "x", None, []]),
        ("items", [1, "x", None, {}]),
        ("text", [1, None, [], {}]),
        ("name", [1, "", " \n"]),
        ("truth", [1, 0, "true", None]),
        ("number", ["1", None, True, 10**400, float("nan"), float("-inf")]),
        ("positive", [0, -1.0, True, float("inf")]),
        ("whole", [1.0, True, "1"]),
        ("count", [-1, 0.5, None]),
    ],
)
def test_another_kind_of_value_is_a_fault_of_its_place(method, wrong):
    for value in wrong:
        with pytest.raises(Fault) as caught:
            getattr(Node(value, "here"), method)()
        assert caught.value.place == "here" and caught.value.what.isprintable()


def test_a_list_of_numbers_says_which_is_none():
    assert Node([1, 2.5], "x").numbers(2) == [1.0, 2.5]
    with pytest.raises(Fault, match=r"^x: expected 3 numbers, found 2$"):
        Node([1, 2.5], "x").numbers(3)
    with pytest.raises(Fault, match=r"^x\[1\]: expected a number, found null$"):
        Node([1, None], "x").numbers(2)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", r"^line 1, column 1: expected JSON, found the end \(expecting value\)$"),
        (b'{"a": 1,\n]', r"^line 2, column 1: expected JSON, found .\]. \("),
        (b"\xff", "^expected UTF-8 text, found byte 0xff at 0$"),
        ("[1]".encode("utf-16-le"), "^expected UTF-8 text, found zero bytes"),
        (b"[" * 100_000, "^expected JSON, found JSON nested too deeply$"),
        (b"1" * 5000, "^expected JSON, found a number of too many digits$"),
    ],
)
def test_what_is_no_json_is_a_fault(data, said):
    with pytest.raises(Fault, match=said):
        parse_json(data)


def test_a_key_twice_is_refused_where_it_matters():
    twice = '{"a": [{"b": 1, "b": 2}]}'
    assert parse_json(twice).value == {"a": [{"b": 2}]}
    with pytest.raises(Fault, match=r'^expected each key once, found the key "b" twice'):
        parse_json(twice, keys_once=True)


def test_a_file_that_is_not_there_or_is_a_folder_is_a_fault(tmp_path):
    with pytest.raises(Fault, match=r"^expected a model, found none$"):
        read_json(tmp_path / "none.json", "a model")
    with pytest.raises(Fault, match=r"^expected a model, found a folder$"):
        read_json(tmp_path, "a model")
