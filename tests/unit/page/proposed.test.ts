import assert from "node:assert/strict";
import { test } from "node:test";
import type { PointsProposal } from "../../../service/page/src/api/types";
import {
  NO_POINTS,
  ask,
  confirm,
  leave,
  nextDoubt,
  nextPoint,
  place,
  remove,
  setHidden,
  skip,
  swapSides,
} from "../../../service/page/src/points/placed";
import { countProposed, hasProposed, isAllProposed, personAt, proposedPoints, wholePerson } from "../../../service/page/src/points/proposed";
import { advance, amend, begin, redo, undo } from "../../../service/page/src/points/timeline";
import { FOUND, proposalOf } from "./proposals";

const proposed = proposedPoints(FOUND);

test("what the service proposes is there as proposals, hidden ones as hidden, and nothing else is asked for", () => {
  assert.equal(isAllProposed(proposed), true);
  assert.equal(countProposed(proposed), Object.keys(FOUND.points).length);
  assert.equal(proposed.placed.left_ankle!.hidden, true);
  assert.equal(nextPoint(proposed), null);
});

test("where a body needs more than is proposed, the rest is asked for before doubts are", () => {
  const { left_shoulder, right_shoulder, left_ankle } = FOUND.points;
  const few = proposedPoints({ ...FOUND, points: { left_shoulder, right_shoulder, left_ankle } as PointsProposal["points"] });
  assert.equal(nextPoint(few), "left_elbow");
  assert.equal(nextDoubt(few), null);
  assert.deepEqual(few.doubts, ["left_ankle"]);
});

test("doubts are asked about one by one, and every answer ends one of them", () => {
  assert.equal(nextDoubt(proposed), "left_ankle");
  const sure = confirm(proposed, "left_ankle");
  assert.deepEqual(sure.placed.left_ankle, { ...proposed.placed.left_ankle!, hidden: false, proposed: false });
  assert.equal(nextDoubt(sure), "right_wrist");
  const hidden = setHidden(sure, "right_wrist", true);
  assert.deepEqual(hidden.placed.right_wrist, { ...proposed.placed.right_wrist!, hidden: true });
  assert.equal(nextDoubt(hidden), null);
  for (const without of [skip(proposed, "left_ankle"), remove(proposed, "left_ankle")]) {
    assert.equal(without.placed.left_ankle, undefined);
    assert.deepEqual(without.doubts, ["right_wrist"]);
  }
});

test("a point to be moved is asked for, lies where it was until then, and is a click afterwards", () => {
  const asked = ask(proposed, "left_ankle");
  assert.equal(nextPoint(asked), "left_ankle");
  assert.deepEqual(asked.placed, proposed.placed);
  assert.equal(nextDoubt(leave(asked)), "left_ankle");
  const moved = place(asked, "left_ankle", 1, 2);
  assert.deepEqual(moved.placed.left_ankle, { x: 1, y: 2, hidden: true, proposed: false });
  assert.equal(nextDoubt(moved), "right_wrist");
  assert.equal(isAllProposed(moved), false);
  assert.equal(hasProposed(moved), true);
});

test("undoing a drag makes a click a proposal again, and undoing the proposal leaves nothing", () => {
  const start = advance(begin(NO_POINTS), proposed);
  const drag = advance(start, { ...proposed });
  const dragged = amend(amend(drag, place(proposed, "left_ankle", 1, 2)), place(proposed, "left_ankle", 3, 4));
  assert.equal(dragged.present.placed.left_ankle!.proposed, false);
  assert.deepEqual(undo(dragged).present, proposed);
  assert.deepEqual(redo(undo(dragged)).present.placed.left_ankle!.x, 3);
  assert.equal(undo(undo(dragged)).present, NO_POINTS);
});

test("sides are swapped with their doubts", () => {
  assert.deepEqual(swapSides(proposed).doubts, ["right_ankle", "left_wrist"]);
});

test("who is tapped on is the one whose middle is nearer, and nobody outside all boxes", () => {
  const boxes = [[0, 0, 100, 200], [80, 0, 160, 200]] as const;
  const at = (x: number, y: number) => personAt(boxes.map((box) => [...box] as [number, number, number, number]), x, y);
  assert.equal(at(20, 100), 0);
  assert.equal(at(85, 100), 0);
  assert.equal(at(98, 100), 1);
  assert.equal(at(170, 100), null);
  assert.equal(at(50, 201), null);
  assert.equal(proposalOf(boxes).persons.length, 2);
});

test("of several the one wholly in the picture is meant, unless that one stands far behind", () => {
  const among = (...persons: [number, number, number, number][]) => wholePerson({ person: 0, persons, image_size: { width: 500, height: 500 } });
  const cut: [number, number, number, number] = [380, 20, 500, 450];
  assert.equal(among(cut, [190, 50, 330, 480]), 1);
  assert.equal(among(cut, [190, 50, 240, 200]), null);
  assert.equal(among([380, 20, 480, 450], [190, 50, 330, 480]), null);
  assert.equal(among(cut), null);
});
