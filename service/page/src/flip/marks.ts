// How limbs stand out on the body that is drawn, and how it takes another shape.
import { BufferAttribute } from "three";
import type { Mesh } from "three";
import { calmNormals } from "../viewer/calm";
import type { GlbBody } from "../viewer/glb";
import type { Flips, TurnedLimb } from "./flips";
import { TURNED_LIMBS } from "./flips";
import { isKnown, shareOf } from "./shares";

/** The limb pointed at, and those that are turned. */
export function markLimbs(mesh: Mesh, pointedAt: TurnedLimb | null, flips: Flips): void {
  const { count, array } = mesh.geometry.getAttribute("position");
  if (!isKnown(array as Float32Array)) return;
  const turned = TURNED_LIMBS.filter((limb) => flips[limb]);
  const marks = new Float32Array(2 * count);
  for (let vertex = 0; vertex < count; vertex++) {
    if (pointedAt) marks[2 * vertex] = shareOf(vertex, pointedAt);
    for (const limb of turned) marks[2 * vertex + 1]! += shareOf(vertex, limb);
  }
  own(mesh, "mark", marks, 2);
}

/** The same mesh with other places: those of `body`. */
export function reshape(mesh: Mesh, { positions, normals, triangles }: GlbBody): void {
  own(mesh, "position", positions, 3);
  own(mesh, "normal", normals, 3);
  own(mesh, "calm", calmNormals({ positions, normals, triangles }), 3);
  // What a ray is tried against first.
  mesh.geometry.computeBoundingSphere();
}

/** An attribute's values, in an array of its own: a body's arrays are others' as well. */
function own(mesh: Mesh, name: string, values: Float32Array, width: number): void {
  const attribute = mesh.geometry.getAttribute(name) as BufferAttribute | undefined;
  if (attribute?.name === OWN) {
    (attribute.array as Float32Array).set(values);
    attribute.needsUpdate = true;
    return;
  }
  const made = new BufferAttribute(values.slice(), width);
  made.name = OWN;
  mesh.geometry.setAttribute(name, made);
}

const OWN = "own";
