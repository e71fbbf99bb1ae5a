import assert from "node:assert/strict";
import { test } from "node:test";
import type { GlbBody } from "../../../service/page/src/viewer/glb";
import { facingOf } from "../../../service/page/src/viewer/facing";

/** A column of points, upright and facing +z; only what facing needs. */
function column(): Float32Array {
  const places: number[] = [];
  for (let y = 0; y <= 1.8; y += 0.05) for (const x of [-0.12, 0, 0.12]) for (const z of [-0.08, 0.1]) places.push(x, y, z);
  return Float32Array.from(places);
}

function turned(positions: Float32Array, angle: number): Float32Array {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return positions.map((_, i) => {
    const [x, y, z] = positions.subarray(i - (i % 3), i - (i % 3) + 3);
    return [c * x! + s * z!, y! + 0.3, c * z! - s * x! - 3][i % 3]!;
  });
}

const body = (positions: Float32Array) => ({ positions, upright: null }) as unknown as GlbBody;

test("a body faces where it is turned, wherever it stands", () => {
  for (const angle of [-2.5, -0.4, 0, 0.7, 3]) {
    assert.ok(Math.abs(facingOf(body(turned(column(), angle)), body(column())) - angle) < 1e-5);
  }
});

test("without an upright body the camera's side is its front", () => {
  assert.equal(facingOf(body(column()), null), 0);
});
