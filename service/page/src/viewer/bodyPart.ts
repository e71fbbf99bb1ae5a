// A body as the mesh that WebGL draws, with all its surface is drawn by.
import { BufferAttribute, BufferGeometry, Mesh, Vector3 } from "three";
import type { ShaderMaterial } from "three";
import { calmNormals } from "./calm";
import type { GlbBody } from "./glb";
import { surfaceMaterial } from "./surface";
import type { Standing } from "./Turntable";

export interface Part extends Standing {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
}

/** A mesh of the body as it is shown, in the light of the posed one. */
export function bodyPart(shown: GlbBody, posed: GlbBody): Part {
  const count = shown.positions.length / 3;
  const grey = (value: number, width: number) => new Float32Array(width * count).fill(value);
  const geometry = new BufferGeometry();
  const add = (name: string, values: Float32Array, width: number) =>
    geometry.setAttribute(name, new BufferAttribute(values, width));
  add("position", shown.positions, 3);
  add("normal", shown.normals, 3);
  add("calm", calmNormals(shown), 3);
  add("tint", scaled(shown.colours, posed.light?.colourScale ?? 1) ?? grey(0.6, 3), 3);
  add("specularity", shown.specularity ?? grey(0, 1), 1);
  add("mark", grey(0, 2), 2);
  geometry.setIndex(new BufferAttribute(shown.triangles, 1));
  geometry.computeBoundingBox();
  const box = geometry.boundingBox!;
  const centre = box.getCenter(new Vector3());
  const material = surfaceMaterial(posed);
  if (shown !== posed && posed.light) moveLight(material, posed, centre);
  return { mesh: new Mesh(geometry, material), centre, size: box.getSize(new Vector3()) };
}

/** The light stands to the canonical body as it stood to the posed one. */
function moveLight(material: ShaderMaterial, posed: GlbBody, centre: Vector3): void {
  if (posed.light!.kind !== "point") return;
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(posed.positions, 3));
  geometry.computeBoundingBox();
  const old = geometry.boundingBox!.getCenter(new Vector3());
  material.uniforms.lightVector!.value.sub(old).add(centre);
}

function scaled(values: Float32Array | null, factor: number): Float32Array | null {
  return values && values.map((value) => value * factor);
}
