import assert from "node:assert/strict";
import { test } from "node:test";
import { LIMB_POINTS, mirrored } from "../../../service/page/src/points/catalogue";
import { namedPoints } from "../../../service/page/src/points/named";
import {
  NO_POINTS,
  ask,
  isEnough,
  missing,
  nextPoint,
  place,
  skip,
  skipRest,
  swapSides,
  toggleHidden,
} from "../../../service/page/src/points/placed";
import { advance, amend, begin, redo, undo } from "../../../service/page/src/points/timeline";

const some = place(place(NO_POINTS, "left_shoulder", 10, 20), "right_hip", 30.5, 40.25);

test("points are asked for in the catalogue's order, past those placed and skipped", () => {
  assert.equal(nextPoint(NO_POINTS), "left_shoulder");
  assert.equal(nextPoint(some), "right_shoulder");
  assert.equal(nextPoint(skip(some, "right_shoulder")), "left_elbow");
});

test("a point asked for out of turn comes next, once", () => {
  const asked = ask(skip(some, "chin"), "chin");
  assert.equal(nextPoint(asked), "chin");
  assert.equal(nextPoint(place(asked, "chin", 1, 2)), "right_shoulder");
});

test("after skipping the rest nothing is asked for", () => {
  assert.equal(nextPoint(skipRest(some)), null);
});

test("limb points suffice only with two shoulders or hips among them", () => {
  const limbs = ["left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_knee", "left_hip"] as const;
  const one = limbs.reduce((points, name, i) => place(points, name, i, i), NO_POINTS);
  assert.deepEqual(missing(one), { limbs: 0, trunk: 1 });
  assert.equal(isEnough(one), false);
  assert.equal(isEnough(place(one, "right_hip", 9, 9)), true);
});

test("swapping sides twice changes nothing, and once moves every sided point", () => {
  assert.deepEqual(swapSides(swapSides(some)), some);
  assert.deepEqual(swapSides(some).placed.right_shoulder, some.placed.left_shoulder);
  assert.equal(mirrored("nose"), "nose");
});

test("moving a hidden point keeps it hidden", () => {
  const hidden = toggleHidden(some, "right_hip");
  assert.equal(place(hidden, "right_hip", 1, 1).placed.right_hip!.hidden, true);
});

test("points by name are read as requests have them, others are left out", () => {
  assert.deepEqual(namedPoints({ nose: [1, 2], left_hip: { x: 3, y: 4, visibility: 1 }, chin: [5, 6, 0], tail: [5, 6] }), {
    nose: { x: 1, y: 2, hidden: false, proposed: false },
    left_hip: { x: 3, y: 4, hidden: true, proposed: false },
  });
});

test("undo and redo walk the same steps, and a drag is one step", () => {
  let line = advance(advance(begin("a"), "b"), "c");
  assert.equal(undo(line).present, "b");
  assert.deepEqual(redo(undo(line)), line);
  line = amend(amend(advance(line, "drag 1"), "drag 2"), "drag 3");
  assert.equal(undo(line).present, "c");
  assert.equal(redo(undo(line)).present, "drag 3");
  assert.equal(undo(begin("a")).present, "a");
  assert.deepEqual(advance(undo(line), "new").future, []);
});

test("the twelve limb points come first", () => {
  assert.ok(LIMB_POINTS.every((name) => /shoulder|elbow|wrist|hip|knee|ankle/.test(name)));
});
