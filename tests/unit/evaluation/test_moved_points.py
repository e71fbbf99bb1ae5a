import numpy as np

from fitter.request import Click
from fitter.vocabulary.choices import Gender
from tests.evaluation.moved_points import Move, MovedFit, moved, moved_lines
from tests.evaluation.table import MEASUREMENTS
from tests.one_picture import one_picture

CLICKS = {
    "nose": Click(x=100.0, y=20.0),
    "left_hip": Click(x=120.0, y=200.0, occluded=True),
    "right_hip": Click(x=80.0, y=200.0),
}
REQUEST = one_picture(image=b"", clicks=CLICKS, gender=Gender.FEMALE, height_m=1.7)


def shifts(move: Move) -> dict[str, tuple[float, float]]:
    clicks = moved(REQUEST, move, 5.0).views[0].clicks
    assert clicks["left_hip"].occluded
    return {
        name: (clicks[name].x - CLICKS[name].x, clicks[name].y - CLICKS[name].y) for name in CLICKS
    }


def test_a_common_move_takes_every_point_the_same_way():
    assert set(shifts(Move.UP).values()) == {(0.0, -5.0)}
    assert set(shifts(Move.ASIDE).values()) == {(5.0, 0.0)}


def test_sides_go_apart_and_together_and_the_middle_stays():
    assert shifts(Move.APART) == {"nose": (0, 0), "left_hip": (5, 0), "right_hip": (-5, 0)}
    assert shifts(Move.TOGETHER) == {"nose": (0, 0), "left_hip": (-5, 0), "right_hip": (5, 0)}


def test_scattered_points_go_equally_far_in_directions_of_their_own():
    found = np.array(list(shifts(Move.SCATTERED).values()))
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 5.0)
    assert len(np.unique(found.round(3), axis=0)) == len(CLICKS)


def test_changes_are_against_the_same_picture_unmoved():
    keys = [key for _, key, _ in MEASUREMENTS]

    def found(picture: str, move: Move, error: float) -> MovedFit:
        return MovedFit(picture=picture, move=move, errors=dict.fromkeys(keys, error))

    still = [found("a", Move.NONE, 1.0), found("b", Move.NONE, -1.0)]
    higher = [found("a", Move.UP, 3.0), found("b", Move.UP, -2.0)]
    others = [
        found(picture, move, 0.0)
        for picture in "ab"
        for move in Move
        if move not in (Move.NONE, Move.UP)
    ]
    lines = [
        line.removeprefix("all up").split()
        for line in moved_lines([*still, *higher, *others])
        if line.startswith("all up")
    ]
    change, errors = lines
    assert change[:2] == ["1.50", "(+0.50)"]
    assert errors == ["2.50"] * len(keys)
