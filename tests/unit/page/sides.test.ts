import assert from "node:assert/strict";
import { test } from "node:test";
import { mirrored } from "../../../service/page/src/points/catalogue";
import type { PointName } from "../../../service/page/src/points/catalogue";
import { NO_POINTS, place, swapSides, toggleHidden } from "../../../service/page/src/points/placed";
import type { Points } from "../../../service/page/src/points/placed";
import { sideDoubt, swapped } from "../../../service/page/src/points/sides";

/** Someone who faces the camera: the left limbs are on the right of the picture. */
const FACING = (
  [
    ["left_shoulder", 440, 220], ["right_shoulder", 250, 225],
    ["left_elbow", 480, 340], ["right_elbow", 180, 320],
    ["left_wrist", 540, 460], ["right_wrist", 230, 410],
    ["left_hip", 390, 466], ["right_hip", 300, 462],
    ["left_knee", 408, 675], ["right_knee", 295, 658],
    ["left_ankle", 398, 822], ["right_ankle", 296, 830],
  ] as const
).reduce<Points>((points, [name, x, y]) => place(points, name, x, y), NO_POINTS);

function only(points: Points, ...names: PointName[]): Points {
  return names.reduce((kept, name) => place(kept, name, points.placed[name]!.x, points.placed[name]!.y), NO_POINTS);
}

function turned(points: Points, map: (x: number, y: number) => [number, number]): Points {
  return (Object.entries(points.placed) as [PointName, { x: number; y: number }][]).reduce(
    (other, [name, { x, y }]) => place(other, name, ...map(x, y)),
    NO_POINTS,
  );
}

test("someone who faces the camera, upright, lying or upside down, raises no doubt", () => {
  assert.equal(sideDoubt(FACING), null);
  assert.equal(sideDoubt(turned(FACING, (x, y) => [-y, x])), null);
  assert.equal(sideDoubt(turned(FACING, (x, y) => [-x, -y])), null);
});

test("two shoulders the other way round are asked about at once", () => {
  const shoulders = only(FACING, "left_shoulder", "right_shoulder");
  assert.equal(sideDoubt(shoulders), null);
  assert.equal(sideDoubt(swapSides(shoulders))?.kind, "behind");
});

test("all sides swapped is a back, unless the face is seen", () => {
  const back = swapSides(FACING);
  assert.equal(sideDoubt(back)?.kind, "behind");
  const face = place(back, "nose", 334, 123);
  assert.equal(sideDoubt(face)?.kind, "facing");
  assert.equal(sideDoubt(toggleHidden(face, "nose"))?.kind, "behind");
});

test("a trunk seen from aside says nothing", () => {
  assert.equal(sideDoubt(turned(swapSides(FACING), (x, y) => [300 + 0.1 * x, y])), null);
});

for (const [what, names] of [
  ["hips", ["left_hip"]],
  ["arms", ["left_elbow", "left_wrist"]],
  ["legs", ["left_knee", "left_ankle"]],
] as const) {
  test(`swapped ${what} alone are told, and swapping what is named mends them`, () => {
    const wrong = swapped(FACING, names);
    const doubt = sideDoubt(wrong);
    assert.equal(doubt?.kind, what);
    assert.equal(sideDoubt(swapped(wrong, doubt!.names)), null);
  });
}

test("hips so near to each other that a click decides their order raise no doubt", () => {
  const [left, right] = [FACING.placed.left_hip!, FACING.placed.right_hip!];
  const middle = (left.x + right.x) / 2;
  // The trunk is 242 pixels long.
  const apart = (px: number) => place(place(FACING, "left_hip", middle - px / 2, 466), "right_hip", middle + px / 2, 466);
  assert.equal(sideDoubt(apart(0.15 * 242)), null);
  assert.equal(sideDoubt(apart(0.25 * 242))?.kind, "hips");
});

test("swapping what a doubt about all sides names is swapping all sides", () => {
  const back = swapSides(FACING);
  assert.deepEqual(swapped(back, sideDoubt(back)!.names).placed, FACING.placed);
});

test("a point without its mirror image changes its side", () => {
  const one = swapped(only(FACING, "left_knee"), ["left_knee"]);
  assert.deepEqual(Object.keys(one.placed), [mirrored("left_knee")]);
});
