import assert from "node:assert/strict";
import { test } from "node:test";
import { fitted, framed, panned, toPicture, toStage, zoomed } from "../../../service/page/src/stage/view";

const stage = { width: 800, height: 600 };
const picture = { width: 720, height: 960 };

test("the whole picture lies in the middle of the stage", () => {
  const view = fitted(stage, picture);
  const [first, last] = [toStage(view, { x: 0, y: 0 }), toStage(view, { x: 720, y: 960 })];
  assert.ok(Math.abs(first.x + last.x - 800) < 1e-9 && Math.abs(first.y + last.y - 600) < 1e-9);
  assert.ok(first.y >= 0 && last.y <= 600);
});

test("stage and picture coordinates invert each other", () => {
  const view = { scale: 2.5, x: -31, y: 17 };
  const spot = toPicture(view, toStage(view, { x: 12.25, y: 99 }));
  assert.ok(Math.abs(spot.x - 12.25) < 1e-12 && Math.abs(spot.y - 99) < 1e-12);
});

test("zooming keeps what lies under the pointer, once the picture covers the stage", () => {
  const whole = zoomed(fitted(stage, picture), 4, { x: 400, y: 300 }, stage, picture);
  const at = { x: 333, y: 222 };
  const before = toPicture(whole, at);
  const after = toPicture(zoomed(whole, 1.7, at, stage, picture), at);
  assert.ok(Math.hypot(before.x - after.x, before.y - after.y) < 1e-9);
});

test("no zoom goes below the whole picture, and no pan loses it", () => {
  const out = zoomed(fitted(stage, picture), 0.01, { x: 0, y: 0 }, stage, picture);
  assert.deepEqual(out, fitted(stage, picture));
  const near = zoomed(out, 6, { x: 400, y: 300 }, stage, picture);
  const far = panned(near, 1e6, -1e6, stage, picture);
  const [first, last] = [toStage(far, { x: 0, y: 0 }), toStage(far, { x: 720, y: 960 })];
  assert.ok(first.x >= 0 && first.x < 800 && last.y > 0 && last.y <= 600);
});

test("a person who is small in a wide picture fills the stage, one who is large leaves it whole", () => {
  const wide = { width: 1600, height: 900 };
  const phone = { width: 390, height: 460 };
  const small = framed(phone, wide, [700, 300, 900, 800]);
  const [head, feet] = [toStage(small, { x: 700, y: 300 }), toStage(small, { x: 900, y: 800 })];
  assert.ok(head.y > 0 && feet.y < 460 && feet.y - head.y > 0.8 * 460 && head.x > 0 && feet.x < 390);
  assert.deepEqual(framed(phone, picture, [100, 60, 600, 900]), fitted(phone, picture));
  assert.deepEqual(framed(phone, wide, null), fitted(phone, wide));
});
