import assert from "node:assert/strict";
import { test } from "node:test";
import { LIMB_POINTS, POINT_NAMES, mirrored } from "../../../service/page/src/points/catalogue";
import { COCO_NAMES, cocoFile, readPoints } from "../../../service/page/src/points/coco";
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
const picture = { name: "a.jpg", width: 100, height: 200 };

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

test("points written as COCO are read back, hidden ones and those beyond COCO too", () => {
  const all = POINT_NAMES.reduce((points, name, i) => place(points, name, i + 0.25, 2 * i), NO_POINTS);
  const written = toggleHidden(all, "left_knee");
  assert.deepEqual(readPoints(cocoFile(written, picture)).placed, written.placed);
});

test("a COCO file holds 17 keypoints in COCO's order, zeros for absent ones", () => {
  const { annotations, categories } = JSON.parse(cocoFile(some, picture));
  assert.deepEqual(categories[0].keypoints, COCO_NAMES);
  const { keypoints, num_keypoints, bbox } = annotations[0];
  assert.equal(keypoints.length, 51);
  assert.deepEqual(keypoints.slice(15, 18), [10, 20, 2]);
  assert.deepEqual(keypoints.slice(0, 3), [0, 0, 0]);
  assert.equal(num_keypoints, 2);
  assert.deepEqual(bbox, [10, 20, 20.5, 20.25]);
});

test("keypoints of others are read: flat, in rows, several people, or by name", () => {
  const flat = COCO_NAMES.flatMap((_, i) => [i, i, i === 0 ? 0 : 1]);
  const rows = COCO_NAMES.map((_, i) => [i, i, i === 0 ? 0 : 1]);
  for (const content of [flat, rows, { keypoints: flat }, { annotations: [{ keypoints: flat.map(() => 0) }, { keypoints: flat }] }]) {
    const { placed } = readPoints(JSON.stringify(content));
    assert.equal(Object.keys(placed).length, 16);
    assert.deepEqual(placed.left_ear, { x: 3, y: 3, hidden: true, proposed: false });
  }
  const named = readPoints('{"points": {"nose": [1, 2], "left_hip": {"x": 3, "y": 4, "visibility": 1}, "tail": [5, 6]}}');
  assert.deepEqual(named.placed, {
    nose: { x: 1, y: 2, hidden: false, proposed: false },
    left_hip: { x: 3, y: 4, hidden: true, proposed: false },
  });
});

test("a file without points is refused with what is missing", () => {
  assert.throws(() => readPoints("x"), /not JSON/);
  assert.throws(() => readPoints('{"a": 1}'), /COCO annotations/);
  assert.throws(() => readPoints("[]"), /COCO annotations/);
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
