import assert from "node:assert/strict";
import { test } from "node:test";
import { placedLabels } from "../../../service/page/src/viewer/labels";

const ROOM = { width: 600, height: 400, step: 20, covered: 0 };

function tape(name: string, x: number, y: number, half = 30) {
  return { name, left: [x - half, y], right: [x + half, y] } as const;
}

test("no label covers another, and all stay in the room", () => {
  const tapes = Array.from({ length: 30 }, (_, i) => tape(`tape ${i}`, 300 + (i % 3) - 1, 180 + i));
  const labels = placedLabels(tapes, ROOM);
  assert.equal(labels.length, 30);
  for (const side of ["left", "right"]) {
    const heights = labels.filter((each) => each.side === side).map(({ y }) => y);
    assert.ok(heights[0]! >= 10 && heights.at(-1)! <= 390);
    heights.slice(1).forEach((y, i) => assert.ok(y - heights[i]! >= 20 - 1e-9));
  }
});

test("a label stands where its tape is if nothing is in the way", () => {
  const [label] = placedLabels([tape("waist", 300, 200)], ROOM);
  assert.deepEqual({ y: label!.y, at: label!.at }, { y: 200, at: [label!.side === "left" ? 270 : 330, 200] });
});

test("tapes of an arm are told on its own side, those of the trunk fill up the other", () => {
  const labels = placedLabels([tape("right arm", 150, 150, 10), tape("left arm", 450, 150, 10), tape("hip", 300, 250), tape("waist", 300, 220)], ROOM);
  const sideOf = Object.fromEntries(labels.map(({ name, side }) => [name, side]));
  assert.equal(sideOf["right arm"], "left");
  assert.equal(sideOf["left arm"], "right");
  assert.notEqual(sideOf.hip, sideOf.waist);
});

test("labels of the right column stay above what covers its foot", () => {
  const tapes = [100, 500].flatMap((x) => Array.from({ length: 6 }, (_, i) => tape(`tape ${i} at ${x}`, x, 340 + i)));
  const labels = placedLabels(tapes, { ...ROOM, covered: 150 });
  const lowest = (side: string) => Math.max(...labels.filter((each) => each.side === side).map(({ y }) => y));
  assert.equal(lowest("right"), 240);
  assert.equal(lowest("left"), 390);
});

test("a tape on the outside of the measured leg stands on its side, however many are on that arm and leg", () => {
  const limbs = Array.from({ length: 6 }, (_, i) => tape(`right arm ${i}`, 200, 100 + 20 * i, 10));
  const trunk = Array.from({ length: 8 }, (_, i) => tape(`trunk ${i}`, 300, 100 + 20 * i));
  const labels = placedLabels([...limbs, ...trunk, tape("outseam", 240, 300, 15)], { ...ROOM, width: 1000 });
  assert.equal(labels.find(({ name }) => name === "outseam")!.side, "left");
});
