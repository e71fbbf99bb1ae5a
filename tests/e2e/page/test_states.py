"""What the page says of itself is so at the very moment it says it: other tests wait for it."""

from playwright.sync_api import expect

from tests.e2e.page.visitor import Visitor

NOTE_SIZES = """() => {
  window.sizes = [];
  new MutationObserver((mutations) => {
    for (const { target } of mutations)
      if (target.matches("canvas")) window.sizes.push([target.width, target.clientWidth]);
  }).observe(document, { subtree: true, attributeFilter: ["data-shows"] });
}"""
NOTE_BALLS = """(ball) => {
  window.balls = [];
  new MutationObserver(() => window.balls.push(ball.toDataURL()))
    .observe(ball, { attributeFilter: ["aria-valuetext"] });
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
    page.route("**/derivations*", lambda route: route.abort())
    page.evaluate(NOTE_SIZES)
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_until_drawn(placement="canonical")
    sizes = page.evaluate("window.sizes")
    assert sizes
    assert all(abs(drawn - seen) <= 1 for drawn, seen in sizes), sizes


def test_the_ball_is_lit_as_it_says(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    page.get_by_role("heading", name="Lens and light").click()
    ball = page.get_by_role("slider", name="Direction of the light")
    ball.evaluate(NOTE_BALLS)
    ball.press("ArrowRight")
    expect(ball).to_have_attribute("aria-valuetext", "5° from the right")
    # What a moment later would have drawn is drawn by now.
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 200)))")
    assert page.evaluate("window.balls") == [ball.evaluate("ball => ball.toDataURL()")]


def test_a_stage_that_is_not_busy_knows_where_its_picture_lies(visitor: Visitor):
    page = visitor.page
    page.evaluate(NOTE_STAGE)
    visitor.open_sample()
    placed = page.evaluate("window.placed")
    assert placed
    assert "scale(1)" not in placed[0]
