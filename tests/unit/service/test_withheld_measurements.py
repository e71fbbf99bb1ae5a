"""What needs measurements says so where they are withheld."""

from service.commands.fit import print_result
from tests.unit.service.fit_results import fit_result

WITHHELD = {"measurements": [], "verdict": "implausible"}


def test_the_command_line_says_how_to_have_them(capsys):
    print_result(fit_result(**WITHHELD))
    told = capsys.readouterr().out
    assert "force" in told
    assert "implausible" in told
    assert "Measurements, male" not in told
