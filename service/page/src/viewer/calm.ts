// Normals as of a tailor's dummy: clay has no face, nipples or genitals. The mesh itself stays as it is.
import type { GlbBody } from "./glb";

/** How often each normal becomes the mean of its neighbours'; and how often where edges are shorter than this, metres. */
const PASSES = 3;
const FINE_PASSES = 80;
const FINE = 0.012;

export function calmNormals({ positions, normals, triangles }: Pick<GlbBody, "positions" | "normals" | "triangles">): Float32Array {
  const count = positions.length / 3;
  const lengths = new Float32Array(count);
  const degrees = new Uint16Array(count);
  const eachEdge = (visit: (from: number, to: number) => void) => {
    for (let i = 0; i < triangles.length; i += 3) {
      for (let corner = 0; corner < 3; corner++) visit(triangles[i + corner]!, triangles[i + ((corner + 1) % 3)]!);
    }
  };
  eachEdge((from, to) => {
    const [dx, dy, dz] = [0, 1, 2].map((k) => positions[3 * from + k]! - positions[3 * to + k]!);
    lengths[from]! += Math.hypot(dx!, dy!, dz!);
    degrees[from]!++;
  });
  const ends: number[] = [];
  const fineEnds: number[] = [];
  eachEdge((from, to) => {
    ends.push(from, to);
    if (lengths[from]! < FINE * degrees[from]!) fineEnds.push(from, to);
  });
  let calm = Float32Array.from(normals);
  for (let pass = 0; pass < PASSES + FINE_PASSES; pass++) {
    const pairs = pass < PASSES ? ends : fineEnds;
    const next = calm.slice();
    for (let i = 0; i < pairs.length; i += 2) next.fill(0, 3 * pairs[i]!, 3 * pairs[i]! + 3);
    for (let i = 0; i < pairs.length; i += 2) {
      const [from, to] = [pairs[i]!, pairs[i + 1]!];
      for (let k = 0; k < 3; k++) next[3 * from + k]! += calm[3 * to + k]! / degrees[from]!;
    }
    calm = next;
  }
  return calm;
}
