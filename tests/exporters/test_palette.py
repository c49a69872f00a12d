from __future__ import annotations

import numpy as np

from exporters.palette import (
    action_colors,
    effort_color,
    linear_from_srgb,
    performer_colors,
    srgb_from_linear,
)
from laban import AXES
from tests.naive.puppet import puppet


def test_an_action_has_the_same_colour_whenever_it_is_played():
    assert action_colors(["walk", "run", "bow"]) == action_colors(["bow", "walk", "run", "walk"])


def test_ten_actions_have_ten_colours():
    colors = action_colors("abcdefghij")
    assert len(set(colors.values())) == 10
    assert np.all((np.array(list(colors.values())) >= 0) & (np.array(list(colors.values())) <= 1))


def test_the_first_performer_keeps_its_colours_and_the_others_differ():
    own = [mesh.color_rgb for mesh in puppet().meshes]
    np.testing.assert_allclose(performer_colors(puppet(), 0), own)
    shown = [tuple(performer_colors(puppet(), i)[0]) for i in range(6)]
    apart = [np.linalg.norm(np.subtract(a, b)) for a in shown for b in shown if a is not b]
    assert min(apart) > 0.05


def test_srgb_and_linear_are_inverse_and_agree_with_the_standard():
    levels = np.linspace(0.0, 1.0, 101)
    np.testing.assert_allclose(srgb_from_linear(linear_from_srgb(levels)), levels, atol=1e-6)
    np.testing.assert_allclose(linear_from_srgb(0.5), 0.214041, atol=1e-6)


def test_every_axis_of_effort_has_a_colour_of_its_own():
    assert len({effort_color(axis) for axis in AXES}) == len(AXES)
