// Which way a body faces: how far its trunk is turned about the vertical from that of the upright body, which faces +z.
import { Quaternion, Vector3 } from "three";
import type { GlbBody } from "./glb";

/** Of the upright body's height: above the hips and below the shoulders, and within the arms. */
const TRUNK = { from: 0.55, to: 0.78, halfWidth: 0.09 } as const;

/** Radians to the right of +z as one looks at it; the posed body is set upright first. */
export function facingOf(posed: GlbBody, canonical: GlbBody | null): number {
  if (!canonical) return 0;
  const turn = new Quaternion();
  if (posed.upright) turn.fromArray(posed.upright);
  const from = canonical.positions;
  const trunk = trunkOf(from);
  const before = trunk.map((vertex) => new Vector3().fromArray(from, 3 * vertex));
  const after = trunk.map((vertex) => new Vector3().fromArray(posed.positions, 3 * vertex).applyQuaternion(turn));
  const [centreBefore, centreAfter] = [meanOf(before), meanOf(after)];
  // The rotation in the plane that takes one to the other with the least squares.
  let [cross, dot] = [0, 0];
  before.forEach((point, i) => {
    const [x, z] = [point.x - centreBefore.x, point.z - centreBefore.z];
    const [turnedX, turnedZ] = [after[i]!.x - centreAfter.x, after[i]!.z - centreAfter.z];
    cross += z * turnedX - x * turnedZ;
    dot += x * turnedX + z * turnedZ;
  });
  return Math.atan2(cross, dot);
}

function trunkOf(positions: Float32Array): number[] {
  const heights = Float32Array.from({ length: positions.length / 3 }, (_, vertex) => positions[3 * vertex + 1]!);
  const low = heights.reduce((least, y) => Math.min(least, y), Infinity);
  const height = heights.reduce((most, y) => Math.max(most, y), -Infinity) - low;
  const found: number[] = [];
  heights.forEach((y, vertex) => {
    const share = (y - low) / height;
    const isBetween = share > TRUNK.from && share < TRUNK.to;
    if (isBetween && Math.abs(positions[3 * vertex]!) < TRUNK.halfWidth * height) found.push(vertex);
  });
  return found;
}

function meanOf(points: readonly Vector3[]): Vector3 {
  const sum = new Vector3();
  for (const point of points) sum.add(point);
  return sum.divideScalar(Math.max(1, points.length));
}
