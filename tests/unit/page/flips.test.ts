import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import { bent, jointsOf } from "../../../service/page/src/flip/bent";
import { CHAINS, flipped, isTurnedLimb } from "../../../service/page/src/flip/flips";
import { limbAt, sharesOf } from "../../../service/page/src/flip/shares";
import type { GlbBody } from "../../../service/page/src/viewer/glb";

const VERTICES = 12440;
/** Shoulder, elbow, wrist and finger tips of a left arm that comes forward to the elbow and goes back below it. */
const ARM = [[0.2, 0.4, -3], [0.36, 0.15, -2.7], [0.42, -0.05, -3], [0.43, -0.2, -3.1]].map((at) => new Vector3(...(at as [number, number, number])));
const LEFT_ARM = 0;

function armed(): GlbBody {
  const positions = new Float32Array(3 * VERTICES).fill(-5);
  const normals = new Float32Array(3 * VERTICES).map((_, i) => (i % 3 === 2 ? 1 : 0));
  const between = ARM.slice(1).map((far, i) => far.clone().add(ARM[i]!).multiplyScalar(0.5));
  for (const { vertex, upper, lower, end } of sharesOf(LEFT_ARM)) {
    const place = ARM[0]!.clone().multiplyScalar(Math.max(0, 1 - upper - lower - end));
    [upper, lower, end].forEach((share, i) => place.addScaledVector(between[i]!, share));
    place.toArray(positions, 3 * vertex);
  }
  return { positions, normals } as unknown as GlbBody;
}

const joints = (body: GlbBody) => jointsOf(body.positions, sharesOf(LEFT_ARM));
const slant = (near: Vector3, far: Vector3) => Math.sign(far.length() - near.dot(far) / far.length());

test("a forearm that is turned points the other way, and its wrist is seen where it was", () => {
  const body = armed();
  const before = joints(body);
  assert.equal(slant(before.middle, before.far), 1);
  const after = joints(bent(body, { left_forearm: "toward" })!);
  assert.ok(before.far.angleTo(after.far) < 1e-5);
  assert.ok(after.far.length() < before.far.length() - 0.05);
  assert.ok(Math.abs(after.far.distanceTo(before.middle) - before.far.distanceTo(before.middle)) < 1e-5);
});

test("only what hangs on the limb moves", () => {
  const body = armed();
  const turned = bent(body, { left_forearm: "toward" })!;
  const shares = sharesOf(LEFT_ARM);
  const follows = new Set(shares.filter(({ lower, end }) => lower + end > 0).map(({ vertex }) => vertex));
  const moved = (vertex: number) => [0, 1, 2].some((i) => Math.abs(turned.positions[3 * vertex + i]! - body.positions[3 * vertex + i]!) > 1e-6);
  for (let vertex = 0; vertex < VERTICES; vertex++) if (moved(vertex)) assert.ok(follows.has(vertex));
  assert.ok(shares.filter(({ end }) => end === 1).every(({ vertex }) => moved(vertex)));
});

test("a forearm keeps its slant and its wrist while the upper arm is turned", () => {
  const body = armed();
  const before = joints(body);
  const after = joints(bent(body, { left_upper_arm: "away" })!);
  assert.ok(before.far.angleTo(after.far) < 1e-5);
  assert.equal(slant(before.near, before.middle), -1);
  assert.equal(slant(after.near, after.middle), 1);
});

test("where a limb points already it stays", () => {
  const body = armed();
  const same = bent(body, { left_forearm: "away" })!;
  body.positions.forEach((value, i) => assert.ok(Math.abs(value - same.positions[i]!) < 1e-5));
});

test("a body of another mesh is left alone", () => {
  assert.equal(bent({ positions: new Float32Array(30) } as unknown as GlbBody, { left_forearm: "away" }), null);
});

test("every limb has vertices of its own, and hands and feet are of the lower ones", () => {
  CHAINS.forEach(([upper, lower], chain) => {
    const shares = sharesOf(chain);
    const of = (part: "upper" | "lower" | "end") => shares.find((share) => share[part] === 1)!.vertex;
    assert.equal(limbAt([of("upper"), of("upper"), of("upper")]), upper);
    assert.equal(limbAt([of("lower"), of("lower"), of("end")]), lower);
  });
});

test("turning a limb twice leaves it as it was found, and the trunk is none", () => {
  const once = flipped({}, "left_shin", "toward");
  assert.deepEqual(once, { left_shin: "away" });
  assert.deepEqual(flipped(once, "left_shin", "toward"), {});
  assert.ok(!isTurnedLimb("torso"));
});
