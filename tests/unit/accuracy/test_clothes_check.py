"""How what is said of clothes is counted."""

from tests.accuracy.clothes_check import SaidOfClothes, clothes_lines


def said(group: str, name: str, word: str) -> SaidOfClothes:
    return SaidOfClothes(group=group, name=name, said=word, regions="upper loose 0.80")


def test_clothes_are_counted_by_group_and_mistakes_are_named():
    lines = clothes_lines(
        [
            said("loose, own", "a", "loose"),
            said("loose, own", "b", "close"),
            said("underwear, own", "c", "bare"),
            said("underwear, own", "d", "loose"),
        ]
    )
    assert lines[1].split()[-4:] == ["1", "1", "0", "0"]
    assert lines[2].split()[-4:] == ["1", "0", "1", "0"]
    assert [line.split(":")[1].split()[0] for line in lines[3:]] == ["b", "d"]
