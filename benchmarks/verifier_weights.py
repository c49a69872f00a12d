"""Where verification's weights come from, and what confidences are worth.

``python -m benchmarks.verifier_weights`` fits the weights of `smd.recognition.verification` to
people 1 to 7 of SHREC'17 (three examples of each gesture a person, the rest weighed) and prints
them beside the shipped ones. What both reach is told of people left out of the fit: one of the
seven in turn, and people 8 to 14, whom nothing was fitted to. For these it also compares
confidences with how often they were right, and with ``--picture FOLDER`` draws that.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.gestures import DATA, REPORTED, Gestures, learned_actions, read_gestures
from benchmarks.gestures import within_people as splits_of
from benchmarks.process import picture_folder
from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition import Recognizer
from smd.recognition.verification import TERMS, WEIGHTS

FITTED = tuple(range(1, 8))
RIDGE = 1e-3
"""Of the squared weights, a gesture: it only keeps a weight that tells nothing from growing."""

BINS = 10

UNKNOWN = 100.0
"""Every term of a gesture that a person has too few examples of to teach: out of the question."""


@dataclass(frozen=True)
class Weighed:
    """What n gestures were weighed by: terms without weights ``(n, actions, 9)``.

    ``right (n,)`` is the number of the action that was meant, ``person (n,)`` whose it is.
    """

    terms: FloatArray
    right: IntArray
    person: IntArray


def weighed(data: Gestures) -> Weighed:
    """Return the terms of every tested gesture and each action of its person."""
    terms, rights, persons = [], [], []
    for learned, tested in splits_of(data):
        recognizer = Recognizer(learned_actions(data, learned))
        for i in tested.tolist():
            matches = {match.action: match for match in recognizer.rank(data.doodles[i])}
            rows = np.full((len(np.unique(data.label)), len(TERMS)), UNKNOWN)
            for row, name in zip(rows, recognizer.names, strict=False):
                row[:] = [value for _, value in matches[name].terms] / WEIGHTS
            terms.append(rows)
            rights.append(recognizer.names.index(str(data.label[i])))
            persons.append(int(data.person[i]))
    return Weighed(np.stack(terms), np.array(rights), np.array(persons))


def log_likelihoods(weights: FloatArray, data: Weighed) -> FloatArray:
    """Return ``(n, actions)``: the logarithm of each action's share of the likelihood."""
    cost = data.terms @ weights
    cost = cost - cost.min(axis=1, keepdims=True)
    return -cost - np.log(np.exp(-cost).sum(axis=1, keepdims=True))


def fitted_weights(data: Weighed) -> FloatArray:
    """Return the non-negative weights of most likelihood (conditional logit, McFadden 1974)."""
    from scipy.optimize import minimize

    rows = np.arange(len(data.right))
    meant = data.terms[rows, data.right]

    def loss(weights: FloatArray) -> tuple[float, FloatArray]:
        logs = log_likelihoods(weights, data)
        expected = np.einsum("na,nat->nt", np.exp(logs), data.terms)
        value = -logs[rows, data.right].mean() + RIDGE * weights @ weights
        return float(value), (meant - expected).mean(axis=0) + 2.0 * RIDGE * weights

    start = np.ones(len(TERMS))
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=[(0.0, None)] * len(start))
    return np.asarray(found.x)


def summary(weights: FloatArray, data: Weighed) -> str:
    """Return accuracy, log loss, Brier score and calibration error as text."""
    logs = log_likelihoods(weights, data)
    rows = np.arange(len(data.right))
    share = np.exp(logs)
    truth = np.zeros_like(share)
    truth[rows, data.right] = 1.0
    return (
        f"right {100.0 * np.mean(logs.argmax(axis=1) == data.right):.1f} %, "
        f"log loss {-logs[rows, data.right].mean():.3f}, "
        f"Brier score {np.square(share - truth).sum(axis=1).mean():.3f}, "
        f"calibration error {calibration_error(*confidences(weights, data)):.3f}"
    )


def confidences(weights: FloatArray, data: Weighed) -> tuple[FloatArray, FloatArray]:
    """Return the best action's confidence in each gesture, and whether it is right."""
    logs = log_likelihoods(weights, data)
    best = logs.argmax(axis=1)
    return np.exp(logs.max(axis=1)), (best == data.right).astype(np.float64)


def reliability(confidence: FloatArray, right: FloatArray) -> list[tuple[float, float, int]]:
    """Return mean confidence, share right and count of each bin of equal count."""
    order = np.argsort(confidence, kind="stable")
    return [
        (float(confidence[part].mean()), float(right[part].mean()), len(part))
        for part in np.array_split(order, BINS)
    ]


def calibration_error(confidence: FloatArray, right: FloatArray) -> float:
    """Return the mean difference between confidence and share right, over bins of equal count."""
    bins = reliability(confidence, right)
    return sum(n * abs(said - was) for said, was, n in bins) / len(right)


def draw(path: Path, data: Weighed) -> None:
    """Draw confidences of the shipped weights against how often they were right."""
    from matplotlib.figure import Figure

    said, was, _ = zip(*reliability(*confidences(WEIGHTS, data)), strict=True)
    figure = Figure(figsize=(4.0, 4.0), dpi=100, layout="constrained")
    axes = figure.subplots()
    axes.plot([0.0, 1.0], [0.0, 1.0], color="0.7", linewidth=1.0)
    axes.plot(said, was, "o-", color="#2b6cb0")
    axes.set(xlabel="confidence", ylabel="share right", xlim=(0, 1.02), ylim=(0, 1.02))
    axes.set_title("people that nothing was fitted to", fontsize=10)
    figure.savefig(path)


def main() -> None:
    """Print the fit beside what is shipped."""
    if not (DATA / "gestures").is_dir():
        print(f"data absent ({DATA / 'gestures'})")
        return
    own, others = weighed(read_gestures(FITTED)), weighed(read_gestures(REPORTED))
    fit = fitted_weights(own)
    print("weights      " + "".join(f"{name:>15}" for name in TERMS))
    for name, weights in (("fitted", fit), ("shipped", WEIGHTS)):
        print(f"{name:13}" + "".join(f"{weight:15.2f}" for weight in weights))
    print(f"people 1 to 7, {len(own.right)} gestures, each person left out of the fit in turn:")
    for person in np.unique(own.person):
        rest, left = (
            Weighed(own.terms[which], own.right[which], own.person[which])
            for which in (own.person != person, own.person == person)
        )
        print(f"  person {person}: fitted {summary(fitted_weights(rest), left)}")
        print(f"            shipped {summary(WEIGHTS, left)}")
    print(f"people 8 to 14, {len(others.right)} gestures:")
    print(f"  fitted  {summary(fit, others)}")
    print(f"  shipped {summary(WEIGHTS, others)}")
    for said, was, n in reliability(*confidences(WEIGHTS, others)):
        print(f"    confidence {said:.2f}: right {was:.2f} of {n}")
    if folder := picture_folder():
        draw(folder / "confidence.png", others)


if __name__ == "__main__":
    main()
