// Which limb each vertex of the body follows, and how far (`python -m tests.illustrations.limb_shares`).
import content from "./shares.bin";
import { CHAINS } from "./flips";
import type { TurnedLimb } from "./flips";

const FULL = 255;
const COUNT = content.length / 4;
/** Planes: number of the chain, from 1 on, and the shares of its upper limb, its lower limb and its end. */
const [chains, upper, lower, end] = [0, 1, 2, 3].map((plane) => content.subarray(plane * COUNT, (plane + 1) * COUNT)) as [Uint8Array, Uint8Array, Uint8Array, Uint8Array];

export interface Share {
  readonly vertex: number;
  readonly upper: number;
  readonly lower: number;
  /** Hand or foot. */
  readonly end: number;
}

/** Bodies of other meshes have other vertices. */
export function isKnown(positions: Float32Array): boolean {
  return positions.length === 3 * COUNT;
}

/** The vertices that follow a chain's limbs at all. */
export function sharesOf(chain: number): readonly Share[] {
  const found: Share[] = [];
  chains.forEach((number, vertex) => {
    if (number === chain + 1) found.push({ vertex, upper: upper[vertex]! / FULL, lower: lower[vertex]! / FULL, end: end[vertex]! / FULL });
  });
  return found;
}

/** How far a vertex is of a limb, hand and foot being of the lower one's. */
export function shareOf(vertex: number, limb: TurnedLimb): number {
  const chain = CHAINS[chains[vertex]! - 1];
  if (!chain) return 0;
  if (limb === chain[0]) return upper[vertex]! / FULL;
  return limb === chain[1] ? (lower[vertex]! + end[vertex]!) / FULL : 0;
}

/** The limb that a triangle of these vertices is of, null of head and trunk. */
export function limbAt(vertices: readonly number[]): TurnedLimb | null {
  const chain = CHAINS[chains[vertices[0]!]! - 1];
  const half = vertices.length / 2;
  return chain?.find((limb) => vertices.reduce((sum, vertex) => sum + shareOf(vertex, limb), 0) > half) ?? null;
}
