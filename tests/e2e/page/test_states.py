"""What the page says of itself is so at the very moment it says it: other tests wait for it."""

from tests.e2e.page.visitor import Visitor

NOTE_SIZES = """() => {
  window.sizes = [];
  new MutationObserver((mutations) => {
    for (const { target } of mutations)
      if (target.matches("canvas")) window.sizes.push([target.width, target.clientWidth]);
  }).observe(document, { subtree: true, attributeFilter: ["data-shows"] });
}"""
NOTE_STAGE = """() => {
  window.placed = [];
  new MutationObserver(() => {
    const stage = document.querySelector('.stage[aria-busy="false"]');
    if (stage) window.placed.push(stage.querySelector(".stage-picture").style.transform);
  }).observe(document, { subtree: true, childList: true, attributeFilter: ["aria-busy"] });
}"""


def test_a_canvas_says_what_it_shows_once_it_has_its_size(visitor: Visitor, finished_fit: str):
    page = visitor.page
    # The skin, which comes at any time, leaves the body less room.
    page.route("**/products", lambda route: route.abort())
    page.evaluate(NOTE_SIZES)
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_until_drawn(placement="canonical")
    sizes = page.evaluate("window.sizes")
    assert sizes
    assert all(abs(drawn - seen) <= 1 for drawn, seen in sizes), sizes


def test_a_stage_that_is_not_busy_knows_where_its_picture_lies(visitor: Visitor):
    page = visitor.page
    page.evaluate(NOTE_STAGE)
    visitor.open_sample()
    placed = page.evaluate("window.placed")
    assert placed
    assert "scale(1)" not in placed[0]
