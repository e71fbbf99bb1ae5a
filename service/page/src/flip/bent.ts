// A body with limbs turned toward its camera or away, as its picture allows: H.-J. Lee and Z. Chen, CVGIP 30(2), 1985.
// The far end of a limb stays on its ray and at the limb's length from its near end, which leaves two places. A preview:
// a fit looks for the whole body anew.
import { Quaternion, Vector3 } from "three";
import type { Facing } from "../api/types";
import type { GlbBody } from "../viewer/glb";
import { CHAINS } from "./flips";
import type { Flips } from "./flips";
import { isKnown, sharesOf } from "./shares";
import type { Share } from "./shares";

interface Joints {
  readonly near: Vector3;
  readonly middle: Vector3;
  readonly far: Vector3;
}

/** A turn about a point that may have moved itself. */
interface Motion {
  readonly from: Vector3;
  readonly to: Vector3;
  readonly turn: Quaternion;
}

/** The body in its camera's axes with these limbs turned; null for a body of another mesh. */
export function bent(body: GlbBody, flips: Flips): GlbBody | null {
  if (!isKnown(body.positions)) return null;
  const [positions, normals] = [body.positions.slice(), body.normals.slice()];
  CHAINS.forEach(([upper, lower], chain) => {
    if (!flips[upper] && !flips[lower]) return;
    const shares = sharesOf(chain);
    const before = jointsOf(body.positions, shares);
    const after = reached(before, flips[upper], flips[lower]);
    move(positions, normals, shares, motion(before.near, before.middle, after.near, after.middle), motion(before.middle, before.far, after.middle, after.far));
  });
  return { ...body, positions, normals };
}

/** Where one part of a chain goes over into the next: the middle of the vertices that follow both. */
export function jointsOf(positions: Float32Array, shares: readonly Share[]): Joints {
  const middle = (weight: (share: Share) => number) => {
    const [sum, place] = [new Vector3(), new Vector3()];
    let total = 0;
    for (const share of shares) {
      sum.addScaledVector(place.fromArray(positions, 3 * share.vertex), weight(share));
      total += weight(share);
    }
    return sum.divideScalar(total);
  };
  return {
    near: middle(({ upper, lower, end }) => upper * Math.max(0, 1 - upper - lower - end)),
    middle: middle(({ upper, lower }) => upper * lower),
    far: middle(({ lower, end }) => lower * end),
  };
}

function reached({ near, middle, far }: Joints, upper: Facing | undefined, lower: Facing | undefined): Joints {
  const knee = upper ? reach(near, middle, near.distanceTo(middle), upper) : middle;
  // What hangs on a limb that was turned keeps its own slant.
  return { near, middle: knee, far: reach(knee, far, middle.distanceTo(far), lower ?? facing(middle, far)) };
}

function facing(from: Vector3, to: Vector3): Facing {
  return to.length() < from.dot(to) / to.length() ? "toward" : "away";
}

/** ‖t u − P‖ = L: t = u·P ∓ √((u·P)² − ‖P‖² + L²) along the ray u; nearest to it where the limb is too short. */
function reach(from: Vector3, to: Vector3, length: number, wanted: Facing): Vector3 {
  const ray = to.clone().normalize();
  const along = from.dot(ray);
  const half = Math.sqrt(Math.max(0, along ** 2 - from.lengthSq() + length ** 2));
  return ray.multiplyScalar(wanted === "toward" ? along - half : along + half);
}

function motion(near: Vector3, far: Vector3, movedNear: Vector3, movedFar: Vector3): Motion {
  const direction = (from: Vector3, to: Vector3) => to.clone().sub(from).normalize();
  return { from: near, to: movedNear, turn: new Quaternion().setFromUnitVectors(direction(near, far), direction(movedNear, movedFar)) };
}

/** Linear blend skinning: what follows neither limb stays. */
function move(positions: Float32Array, normals: Float32Array, shares: readonly Share[], upper: Motion, lower: Motion): void {
  for (const share of shares) {
    const at = 3 * share.vertex;
    const [place, normal] = [new Vector3().fromArray(positions, at), new Vector3().fromArray(normals, at)];
    const below = share.lower + share.end;
    const still = 1 - share.upper - below;
    const placed = (by: Motion) => place.clone().sub(by.from).applyQuaternion(by.turn).add(by.to);
    const turned = (by: Motion) => normal.clone().applyQuaternion(by.turn);
    place.clone().multiplyScalar(still).addScaledVector(placed(upper), share.upper).addScaledVector(placed(lower), below).toArray(positions, at);
    normal.clone().multiplyScalar(still).addScaledVector(turned(upper), share.upper).addScaledVector(turned(lower), below).normalize().toArray(normals, at);
  }
}
