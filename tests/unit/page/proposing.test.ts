import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import type { PointsProposal } from "../../../service/page/src/api/types";
import { change, points, timeline, uploaded } from "../../../service/page/src/draft/draft";
import {
  canPropose,
  choosePersonAt,
  clickAll,
  forgetProposal,
  isProposing,
  others,
  proposal,
  proposalProblem,
  proposalWord,
  propose,
  proposeFirst,
  startProposing,
} from "../../../service/page/src/draft/proposing";
import { NO_POINTS, place } from "../../../service/page/src/points/placed";
import { isAllProposed } from "../../../service/page/src/points/proposed";
import { begin, undo } from "../../../service/page/src/points/timeline";
import { FOUND, NOBODY_FOUND, proposalOf } from "./proposals";

const KEPT = { id: "a picture" } as NonNullable<typeof uploaded.value>;
const TWO = [[0, 0, 100, 200], [200, 0, 300, 200]] as const;

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

startProposing();

beforeEach(() => {
  asked = [];
  globalThis.fetch = async (path, init) => {
    asked.push({ path: String(path), body: JSON.parse(String(init?.body)) });
    return answer();
  };
  forgetProposal();
  canPropose.value = true;
  uploaded.value = null;
  timeline.value = begin(NO_POINTS);
});

test("points are asked for once the picture is there, and taking them back leaves none", async () => {
  answer = found(FOUND);
  proposeFirst();
  assert.equal(asked.length, 0);
  assert.equal(isProposing.value, true);
  uploaded.value = KEPT;
  await settled();
  assert.deepEqual(asked.map(({ path, body }) => [path, body.image_id, body.person]), [["/v1/points", "a picture", null]]);
  assert.equal(isAllProposed(points.value), true);
  assert.equal(isProposing.value, false);
  timeline.value = undo(timeline.value);
  assert.equal(points.value, NO_POINTS);
});

test("who has begun to click goes on, until they ask for proposals", async () => {
  answer = found(FOUND);
  proposeFirst();
  change(place(NO_POINTS, "nose", 1, 2));
  uploaded.value = KEPT;
  await settled();
  assert.deepEqual(Object.keys(points.value.placed), ["nose"]);
  propose();
  await settled();
  assert.equal(isAllProposed(points.value), true);
  clickAll();
  assert.equal(points.value, NO_POINTS);
  propose();
  await settled();
  assert.equal(isAllProposed(points.value), true);
});

test("nobody found is said, and nothing is placed", async () => {
  answer = found(NOBODY_FOUND);
  proposeFirst();
  uploaded.value = KEPT;
  await settled();
  assert.equal(points.value, NO_POINTS);
  assert.match(proposalWord.value!, /Nobody was found/);
  change(place(NO_POINTS, "nose", 1, 2));
  assert.equal(proposalWord.value, null);
});

test("among several a tap chooses another one, until a point is clicked", async () => {
  answer = found(proposalOf(TWO));
  proposeFirst();
  uploaded.value = KEPT;
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
  proposeFirst();
  uploaded.value = KEPT;
  await settled();
  assert.equal(canPropose.value, false);
  assert.equal(proposalProblem.value, null);
  forgetProposal();
  proposeFirst();
  await settled();
  assert.equal(asked.length, 1);
  assert.equal(isProposing.value, false);
});

test("another problem is told, and asking again may help", async () => {
  answer = refused(503, "not-ready");
  proposeFirst();
  uploaded.value = KEPT;
  await settled();
  assert.equal(proposalProblem.value?.code, "not-ready");
  assert.equal(canPropose.value, true);
  answer = found(FOUND);
  propose();
  await settled();
  assert.equal(proposalProblem.value, null);
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
  proposeFirst();
  uploaded.value = KEPT;
  forgetProposal();
  uploaded.value = null;
  release();
  await settled();
  assert.equal(points.value, NO_POINTS);
  assert.equal(proposal.value, null);
});
