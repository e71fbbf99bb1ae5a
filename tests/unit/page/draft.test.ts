// A draft of one picture or several: what is still to do, and what is asked for.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { addView, beginWith, change, current, isAwaiting, labels, lookAt, newView, person, points, removeView, replaceView, todo, views } from "../../../service/page/src/draft/draft";
import { NOBODY } from "../../../service/page/src/draft/person";
import type { Picture } from "../../../service/page/src/draft/picture";
import { initialPoseRequest, loadPerson, loadView, viewRequest, wholeRequest } from "../../../service/page/src/draft/request";
import { namedPoints } from "../../../service/page/src/points/named";
import { NO_POINTS, confirm, place } from "../../../service/page/src/points/placed";
import { proposedPoints } from "../../../service/page/src/points/proposed";
import { FOUND } from "./proposals";

const picture = (name: string) => ({ name, url: `blob:${name}`, width: 720, height: 960, kept: null }) as Picture;
const proposed = proposedPoints(FOUND);

beforeEach(() => {
  beginWith([newView(picture("front"), 0)]);
  person.value = { ...NOBODY, gender: "female" };
});

test("nothing is left to do once points are placed, or awaited", () => {
  assert.ok(isAwaiting(current.value!));
  assert.equal(todo.value, null);
  current.value!.wish.value = null;
  assert.match(todo.value!, /more points$/);
  change(proposed);
  assert.equal(todo.value, null);
  person.value = { ...person.value, height: "tall" };
  assert.match(todo.value!, /height/);
  beginWith([]);
  assert.match(todo.value!, /picture/);
});

test("of several pictures each has its own points, and the one that lacks some is named", () => {
  change(proposed);
  addView(picture("side"));
  assert.deepEqual([labels.value, points.value], [["Front", "Side"], NO_POINTS]);
  current.value!.wish.value = null;
  assert.match(todo.value!, /: Side$/);
  lookAt(0);
  assert.equal(points.value, proposed);
  replaceView(picture("another"));
  assert.deepEqual([views.value.map((each) => each.picture.name), points.value], [["another", "side"], NO_POINTS]);
  removeView();
  assert.deepEqual(views.value.map((each) => each.picture.name), ["side"]);
});

test("with another picture begins somebody else, in the same units", () => {
  person.value = { ...person.value, units: "imperial", weight: "150" };
  beginWith([newView(picture("other"), 0)]);
  assert.deepEqual(person.value, { ...NOBODY, units: "imperial" });
});

test("points that are awaited are left to the service, and one picture alone says nothing of its side", () => {
  assert.deepEqual(viewRequest(current.value!), { points: "auto" });
  addView(picture("side"));
  assert.deepEqual(views.value.map((each) => viewRequest(each).view), ["front", "side"]);
});

test("untouched proposals are sent as such, all others as clicks, and come back so", () => {
  const mixed = confirm(place(proposed, "nose", 5, 6), "left_ankle");
  change(mixed);
  const sent = viewRequest(current.value!).points as Record<string, object>;
  assert.deepEqual(sent.nose, { x: 5, y: 6, visibility: 2 });
  const { x, y } = FOUND.points.left_knee!;
  assert.deepEqual(sent.left_knee, { x, y, visibility: 2, source: "proposal" });
  assert.equal("source" in sent.left_ankle!, false);
  assert.deepEqual(namedPoints(sent), mixed.placed);
});

test("what was asked for is taken up as it was sent", () => {
  const asked = { ...wholeRequest("male"), height_m: 1.8, weight_kg: 80, measurements: { hip_girth: 98 } };
  loadPerson(asked);
  assert.deepEqual([person.value.gender, person.value.height, person.value.weight, person.value.tape.hip_girth], ["male", "180", "80", "98"]);
  const view = { view: "back" as const, points: { left_hip: [1, 2, 1] as [number, number, 1] }, clothing: "loose" as const, limb_facing: { torso: "away" as const }, focal_length_35mm: 28 };
  loadView(current.value!, view);
  addView(picture("side"));
  assert.deepEqual(viewRequest(views.value[0]!), { ...view, points: { left_hip: { x: 1, y: 2, visibility: 1 } } });
});

test("a focal length in pixels is shown as on 35 mm film", () => {
  loadView(current.value!, { focal_length_px: 1200 });
  assert.ok(Math.abs(viewRequest(current.value!).focal_length_35mm! - 43.27) < 1e-9);
});

test("the body of the clicks needs a picture's size until the service has it", () => {
  change(proposed);
  assert.deepEqual(initialPoseRequest(current.value!, "female").image_size, { width: 720, height: 960 });
});
