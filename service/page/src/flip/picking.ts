// The limb of a body that lies under a place of the canvas.
import { Raycaster, Vector2 } from "three";
import type { Camera, Mesh } from "three";
import type { TurnedLimb } from "./flips";
import { isKnown, limbAt } from "./shares";

/** `x` and `y` as WebGL has them, from -1 to 1; null of head, trunk and room. */
export function limbUnder(mesh: Mesh, camera: Camera, x: number, y: number): TurnedLimb | null {
  const positions = mesh.geometry.getAttribute("position");
  if (!isKnown(positions.array as Float32Array)) return null;
  const caster = new Raycaster();
  caster.setFromCamera(new Vector2(x, y), camera);
  const face = caster.intersectObject(mesh, false)[0]?.face;
  return face ? limbAt([face.a, face.b, face.c]) : null;
}
