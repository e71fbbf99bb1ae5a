"""Body-fat share, as a product."""

import csv
import io

from tests.unit.service.products.samples import made


def test_body_fat_says_why_it_is_withheld_for_the_young():
    adult, child = (made(kind="composition", age_years=age) for age in (30, 12))
    estimates = adult.result.model_dump()["estimates"]
    assert [each["name"] for each in estimates] == ["us_navy", "cun_bae"]
    for each, least in zip(estimates, (3.52, 4.66), strict=True):
        assert 5.0 < each["percent"] < 60.0
        assert each["standard_error"] > least
    withheld = child.result.model_dump()["estimates"]
    assert [each["percent"] for each in withheld] == [None, None]
    assert all("years, not of 12" in each["withheld"][0] for each in withheld)
    table = list(csv.DictReader(io.StringIO(adult.files["composition.csv"].decode())))
    assert [each["name"] for each in table] == ["us_navy", "cun_bae"]
