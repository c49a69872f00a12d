"""A recognizer is made once for the same question, and anew for any other."""

from __future__ import annotations

import gc
import weakref

import smd
from smd.recognition.acceptance import Intent
from smd.recognition.recognizers import recognizer_of


def test_the_same_question_has_the_same_recognizer():
    library = smd.load_library()
    assert recognizer_of(library, figure_height_m=0.2) is recognizer_of(
        library, figure_height_m=0.2, tolerance=1.0, intent=None
    )


def test_any_other_question_has_its_own():
    library = smd.load_library()
    again = smd.load_library(library.folder)  # read anew: other objects, which might have changed
    made = [
        recognizer_of(library, figure_height_m=0.2),
        recognizer_of(library, figure_height_m=0.3),
        recognizer_of(library, figure_height_m=0.2, tolerance=1.5),
        recognizer_of(library, figure_height_m=0.2, intent=Intent.DRAWN),
        recognizer_of(library, figure_height_m=0.2, intent=Intent.FREE),
        recognizer_of(again, figure_height_m=0.2),
    ]
    assert len(set(map(id, made))) == len(made)


def test_the_shipped_library_is_read_once_and_others_each_time():
    shipped = smd.load_library()
    assert smd.load_library() is shipped
    assert smd.load_library(shipped.folder) is not smd.load_library(shipped.folder)


def test_a_library_that_nobody_holds_any_more_is_let_go():
    library = smd.load_library(smd.load_library().folder)
    recognizer = recognizer_of(library, figure_height_m=0.2)
    gone = weakref.ref(library)
    del library
    gc.collect()
    assert gone() is None
    assert recognizer.names  # it needs no library
