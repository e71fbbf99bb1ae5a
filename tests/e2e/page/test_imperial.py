"""Feet, inches and pounds, from the person to the result."""

import re

from playwright.sync_api import expect

from tests.e2e.page.visitor import Visitor


def test_a_fit_in_feet_and_pounds_reaches_its_result(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    visitor.choose("ft, lb")
    height, inches = page.get_by_label("Height", exact=True), page.get_by_label("Height, inches")
    expect(height).to_have_value("5")
    expect(inches).to_have_value("11.02")
    visitor.choose("cm, kg")
    expect(height).to_have_value("180.4")
    visitor.choose("ft, lb")
    inches.fill("")
    height.fill("5'11")
    page.get_by_label("Weight", exact=True).fill("170")
    sent = visitor.sent_request()
    assert round(sent["height_m"], 4) == 1.8034
    assert round(sent["weight_kg"], 2) == 77.11
    visitor.wait_for_result()
    visitor.wait_until_drawn(placement="canonical")
    row = page.get_by_role("row", name=re.compile("^Height"))
    expect(row).to_contain_text("5 ft 11.0 in")
    expect(page.get_by_role("row", name=re.compile("^Weight"))).to_contain_text("170.0 lb")
    expect(page.get_by_role("row", name=re.compile("^Hip"))).to_contain_text(" in")
    visitor.choose("cm, kg")
    expect(row).to_contain_text("180.3")
    visitor.choose("in, lb")
    expect(row).to_contain_text("5 ft 11.0 in")


def test_inches_alone_are_a_height_and_twice_inches_are_not(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    visitor.choose("ft, lb")
    height, inches = page.get_by_label("Height", exact=True), page.get_by_label("Height, inches")
    inches.fill("")
    height.fill("5 ft 11.7 in")
    expect(page.get_by_text("Height is held exactly")).to_be_visible()
    inches.fill("3")
    expect(page.get_by_text("A number is needed here.")).to_be_visible()
    height.fill("")
    inches.fill("71.7")
    visitor.choose("cm, kg")
    expect(height).to_have_value("182.1")
