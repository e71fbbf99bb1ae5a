import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import type { PointsProposal, UploadedImage } from "../../../service/page/src/api/types";
import { addView, beginWith, canPropose, change, current, newView, points, timeline, views } from "../../../service/page/src/draft/draft";
import type { Picture } from "../../../service/page/src/draft/picture";
import { choosePersonAt, clickAll, isProposing, others, proposal, proposalWord, propose, startFollowing } from "../../../service/page/src/draft/proposing";
import { NO_POINTS, place } from "../../../service/page/src/points/placed";
import { isAllProposed } from "../../../service/page/src/points/proposed";
import { undo } from "../../../service/page/src/points/timeline";
import { FOUND, NOBODY_FOUND, proposalOf } from "./proposals";

const KEPT = { id: "a picture" } as UploadedImage;
const TWO = [[0, 0, 100, 200], [200, 0, 300, 200]] as const;
const picture = (kept: UploadedImage | null = null) => ({ name: "a", file: new Blob(), url: "blob:a", kept }) as Picture;

/** What was asked of the service, and what it answers. */
let asked: { path: string; body: { image_id: string; person: number | null } }[];
let answer: () => Response;

const found = (content: PointsProposal) => () => Response.json(content);
const refused = (status: number, code: string) => () =>
  Response.json({ code, title: code, detail: code, status }, { status, headers: { "Content-Type": "application/problem+json" } });
/** Until the answer has been taken. */
const settled = async () => {
  for (let i = 0; i < 5; i++) await new Promise((done) => setTimeout(done));
};

startFollowing();

beforeEach(() => {
  asked = [];
  globalThis.fetch = async (path, init) => {
    if (path === "/v1/images") return Response.json(KEPT);
    asked.push({ path: String(path), body: JSON.parse(String(init?.body)) });
    return answer();
  };
  canPropose.value = true;
  beginWith([]);
});

/** A picture that the service has already. */
function open(): void {
  beginWith([newView(picture(KEPT), 0)]);
}

test("a picture is uploaded, its points are asked for, and taking them back leaves none", async () => {
  answer = found(FOUND);
  beginWith([newView(picture(), 0)]);
  assert.equal(isProposing.value, true);
  await settled();
  assert.deepEqual(asked.map(({ path, body }) => [path, body.image_id, body.person]), [["/v1/points", "a picture", null]]);
  assert.equal(isAllProposed(points.value), true);
  assert.equal(isProposing.value, false);
  timeline.value = undo(timeline.value);
  assert.equal(points.value, NO_POINTS);
});

test("every picture of several is followed", async () => {
  answer = found(FOUND);
  open();
  addView(picture(KEPT));
  await settled();
  assert.equal(asked.length, 2);
  assert.ok(views.value.every((view) => isAllProposed(view.timeline.value.present)));
});

test("who has begun to click goes on, until they ask for proposals", async () => {
  answer = found(FOUND);
  open();
  change(place(NO_POINTS, "nose", 1, 2));
  await settled();
  assert.deepEqual(Object.keys(points.value.placed), ["nose"]);
  for (let times = 0; times < 2; times++) {
    propose();
    await settled();
    assert.equal(isAllProposed(points.value), true);
    clickAll();
    assert.equal(points.value, NO_POINTS);
  }
});

test("nobody found is said, and nothing is placed", async () => {
  answer = found(NOBODY_FOUND);
  open();
  await settled();
  assert.equal(points.value, NO_POINTS);
  assert.match(proposalWord.value!, /Nobody was found/);
  change(place(NO_POINTS, "nose", 1, 2));
  assert.equal(proposalWord.value, null);
});

test("among several a tap chooses another one, until a point is clicked", async () => {
  answer = found(proposalOf(TWO));
  open();
  await settled();
  assert.equal(others.value.length, 2);
  choosePersonAt(50, 100);
  choosePersonAt(150, 100);
  await settled();
  assert.equal(asked.length, 1);
  answer = found(proposalOf(TWO, 1));
  choosePersonAt(250, 100);
  await settled();
  assert.equal(asked[1]!.body.person, 1);
  assert.equal(points.value.person, 1);
  // Taking it back is the first one's points again, and another tap the second's.
  timeline.value = undo(timeline.value);
  assert.equal(points.value.person, 0);
  choosePersonAt(250, 100);
  await settled();
  assert.equal(points.value.person, 1);
  change(place(points.value, "nose", 1, 2));
  assert.equal(others.value.length, 0);
  // Proposed anew, it is the same person's.
  propose();
  await settled();
  assert.equal(asked[3]!.body.person, 1);
});

test("a service without the detector is asked once, and no problem is told", async () => {
  answer = refused(404, "detector-not-installed");
  open();
  await settled();
  assert.equal(canPropose.value, false);
  assert.equal(current.value!.proposalProblem.value, null);
  assert.equal(isProposing.value, false);
  open();
  await settled();
  assert.equal(asked.length, 1);
  assert.equal(isProposing.value, false);
});

test("another problem is told, and asking again may help", async () => {
  answer = refused(503, "not-ready");
  open();
  await settled();
  assert.equal(current.value!.proposalProblem.value?.code, "not-ready");
  assert.equal(canPropose.value, true);
  answer = found(FOUND);
  propose();
  await settled();
  assert.equal(current.value!.proposalProblem.value, null);
  assert.equal(isAllProposed(points.value), true);
});

test("an answer about the picture before is not taken", async () => {
  let release = () => {};
  const held = new Promise<void>((done) => (release = done));
  globalThis.fetch = async (_, init) => {
    await held;
    init?.signal?.throwIfAborted();
    return Response.json(FOUND);
  };
  open();
  beginWith([]);
  release();
  await settled();
  assert.equal(points.value, NO_POINTS);
  assert.equal(proposal.value, null);
});
