import assert from "node:assert/strict";
import { test } from "node:test";
import { FIRST_RADIUS, LEAST_RADIUS, MOST_RADIUS, extended, shareOf, sliderOf, strokeAt } from "../../../service/page/src/mask/strokes";
import { duration } from "../../../service/page/src/messages/figures";

test("a slider goes from the least radius to the most and back", () => {
  assert.equal(shareOf(0), LEAST_RADIUS);
  assert.ok(Math.abs(shareOf(100) - MOST_RADIUS) < 1e-12);
  assert.ok(Math.abs(shareOf(sliderOf(FIRST_RADIUS)) - FIRST_RADIUS) < 1e-12);
  assert.equal(shareOf(-20), LEAST_RADIUS);
});

test("equal steps of the slider enlarge the brush by equal factors", () => {
  assert.ok(Math.abs(shareOf(40) / shareOf(20) - shareOf(80) / shareOf(60)) < 1e-12);
});

test("a stroke is kept in pixels of the picture, whatever the view", () => {
  const stroke = extended(strokeAt("add", 5, { scale: 2, x: 10, y: 20 }, { x: 110, y: 60 }), { x: 51, y: 22 });
  assert.deepEqual(stroke.path, [{ x: 50, y: 20 }, { x: 51, y: 22 }]);
});

test("times are told in days from two on", () => {
  assert.equal(duration(168), "7 days");
  assert.equal(duration(36), "36 hours");
  assert.equal(duration(1), "1 hour");
});
