// The body in WebGL: over its picture by the fitted camera, or turned freely.
import {
  BufferAttribute,
  BufferGeometry,
  LinearFilter,
  Mesh,
  NoColorSpace,
  Scene,
  ShaderMaterial,
  Texture,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Cues } from "../api/types";
import type { GlbBody } from "./glb";
import { SURFACES, surfaceMaterial } from "./surface";
import type { Surface } from "./surface";
import { Tapes } from "./Tapes";
import type { TapeLines } from "./Tapes";
import { TURNED_FOV_DEG, Turntable } from "./Turntable";
import type { Standing } from "./Turntable";

export type Placement = "picture" | "turned" | "canonical";

export interface PosedAndUpright {
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
}

interface Parts {
  readonly posed: Part;
  readonly canonical: Part | null;
}

interface Part extends Standing {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
}

export class BodyScene {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly table: Turntable;
  private readonly parts: Parts;
  /** The body before shading, where it is to be compared. */
  private outlined: Parts | null = null;
  private cues: Cues = "SES";
  private kind: Surface = "lit";
  private marked: string | null = null;
  private readonly texture: Texture;
  private readonly tapes: Tapes;
  private placement: Placement = "picture";
  private scheduled = 0;
  /** Nothing is drawn before the canvas' size is known: it would be shown stretched. */
  private isSized = false;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly body: GlbBody,
    private readonly upright: GlbBody | null,
    picture: HTMLImageElement,
    tapes: TapeLines,
  ) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(0, 0);
    this.texture = new Texture(picture);
    this.texture.colorSpace = NoColorSpace;
    this.texture.generateMipmaps = false;
    this.texture.minFilter = LinearFilter;
    this.texture.needsUpdate = true;
    this.parts = this.added({ posed: body, canonical: upright });
    this.tapes = new Tapes(tapes);
    this.scene.add(this.tapes.group);
    this.table = new Turntable(canvas, () => this.draw());
    this.place("picture");
  }

  /** Where the body stands, and whence it is looked at. */
  place(placement: Placement): void {
    this.placement = placement;
    this.reveal();
    this.table.enabled = placement !== "picture";
    // Over the picture there is nothing to turn, and a finger may scroll the page.
    this.renderer.domElement.style.touchAction = placement === "picture" ? "auto" : "none";
    if (placement !== "picture") this.table.lookAt(this.shown(), placement === "canonical" ? 0.35 : 0);
    this.draw();
  }

  surface(kind: Surface): void {
    this.kind = kind;
    for (const each of this.all()) each.mesh.material.uniforms.surface!.value = SURFACES.indexOf(kind);
    this.draw();
  }

  /** Take in the body before shading, and what shading changed of it. */
  compareWith(outlined: PosedAndUpright | null): void {
    if (!outlined || this.outlined) return;
    this.outlined = this.added(outlined);
    if (this.upright && outlined.canonical) {
      const shift = new BufferAttribute(shiftAlongNormals(outlined.canonical, this.upright), 1);
      for (const each of partsOf(this.parts)) each.mesh.geometry.setAttribute("shift", shift);
    }
    this.reveal();
    this.draw();
  }

  /** The body by all cues, or before shading; the view stays. */
  show(cues: Cues): void {
    this.cues = cues;
    this.reveal();
    this.draw();
  }

  /** Let the tape of a measurement stand out. */
  mark(measurement: string | null): void {
    this.marked = measurement;
    this.tapes.mark(measurement);
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.table.camera.aspect = width / height;
    this.isSized = true;
    // At once: another size has emptied the canvas.
    this.render();
  }

  /** Turn by an arrow key; false of any other key, and over the picture. */
  turnBy(key: string): boolean {
    return this.placement !== "picture" && this.table.turnBy(key);
  }

  dispose(): void {
    cancelAnimationFrame(this.scheduled);
    this.table.dispose();
    this.texture.dispose();
    this.tapes.dispose();
    for (const each of this.all()) {
      each.mesh.geometry.dispose();
      each.mesh.material.dispose();
    }
    this.renderer.dispose();
  }

  private shown(): Part {
    const { posed, canonical } = (this.cues === "SE" && this.outlined) || this.parts;
    return this.placement === "canonical" && canonical ? canonical : posed;
  }

  private added({ posed, canonical }: PosedAndUpright): Parts {
    const parts = {
      posed: part(posed, posed, this.texture),
      canonical: canonical && part(canonical, posed, this.texture),
    };
    for (const each of partsOf(parts)) this.scene.add(each.mesh);
    return parts;
  }

  private all(): Part[] {
    return [...partsOf(this.parts), ...(this.outlined ? partsOf(this.outlined) : [])];
  }

  private reveal(): void {
    const shown = this.shown();
    for (const each of this.all()) each.mesh.visible = each === shown;
    // Tapes lie on the final body's skin.
    this.tapes.group.visible = shown === this.parts.canonical;
  }

  private draw(): void {
    cancelAnimationFrame(this.scheduled);
    this.scheduled = requestAnimationFrame(() => this.render());
  }

  private render(): void {
    if (!this.isSized) return;
    const { mesh } = this.shown();
    const { camera } = this.table;
    if (this.placement === "picture") this.useFittedCamera();
    else this.useFreeCamera();
    this.setUpright();
    // Light and surface are in the axes of the file.
    mesh.material.uniforms.eye!.value.copy(mesh.worldToLocal(camera.position.clone()));
    this.renderer.render(this.scene, camera);
    // What is drawn, not what is wanted: the outlined body comes later than its choice.
    const cues = this.cues === "SE" && this.outlined ? "SE" : "SES";
    this.renderer.domElement.dataset.shows = [this.placement, this.kind, cues, this.marked ?? "none"].join(" ");
  }

  /** Over its picture the body is in the camera's axes; turned, it stands as gravity has it. */
  private setUpright(): void {
    for (const { posed } of [this.parts, this.outlined ?? this.parts]) {
      const { mesh, centre } = posed;
      mesh.quaternion.identity();
      if (this.placement === "turned" && this.body.upright) mesh.quaternion.fromArray(this.body.upright);
      mesh.position.copy(centre).sub(centre.clone().applyQuaternion(mesh.quaternion));
      mesh.updateMatrixWorld();
    }
  }

  private useFreeCamera(): void {
    this.table.camera.fov = TURNED_FOV_DEG;
    this.table.camera.updateProjectionMatrix();
  }

  /** The pinhole of the fit: at the origin, along -z, its centre where the picture's is. */
  private useFittedCamera(): void {
    const { camera } = this.body;
    if (!camera) return;
    const near = 0.02;
    const far = 100;
    const fitted = this.table.camera;
    fitted.position.set(0, 0, 0);
    fitted.quaternion.identity();
    fitted.updateMatrixWorld();
    fitted.projectionMatrix.makePerspective(
      (-camera.cx / camera.fx) * near,
      ((camera.width - camera.cx) / camera.fx) * near,
      (camera.cy / camera.fx) * near,
      (-(camera.height - camera.cy) / camera.fx) * near,
      near,
      far,
    );
    fitted.projectionMatrixInverse.copy(fitted.projectionMatrix).invert();
  }
}

function partsOf({ posed, canonical }: Parts): Part[] {
  return canonical ? [posed, canonical] : [posed];
}

/** How far each vertex moved outward from one body to the other, along the latter's normals, metres. */
function shiftAlongNormals(before: GlbBody, after: GlbBody): Float32Array {
  const [from, to, normals] = [before.positions, after.positions, after.normals];
  return Float32Array.from({ length: to.length / 3 }, (_, vertex) => {
    let along = 0;
    for (let i = 3 * vertex; i < 3 * vertex + 3; i++) along += (to[i]! - from[i]!) * normals[i]!;
    return along;
  });
}

/** A mesh of the body as it is shown, with the posed one beside it for what the picture says. */
function part(shown: GlbBody, posed: GlbBody, texture: Texture): Part {
  const count = shown.positions.length / 3;
  const grey = (value: number, width: number) => new Float32Array(width * count).fill(value);
  const geometry = new BufferGeometry();
  const add = (name: string, values: Float32Array, width: number) =>
    geometry.setAttribute(name, new BufferAttribute(values, width));
  add("position", shown.positions, 3);
  add("normal", shown.normals, 3);
  add("posed", posed.positions, 3);
  add("posedNormal", posed.normals, 3);
  add("tint", scaled(shown.colours, posed.light?.colourScale ?? 1) ?? grey(0.6, 3), 3);
  add("albedo", shown.albedo ?? grey(0.6, 1), 1);
  add("specularity", shown.specularity ?? grey(0, 1), 1);
  add("lit", shown.lit ?? grey(1, 1), 1);
  add("posedLit", posed.lit ?? grey(1, 1), 1);
  add("shift", grey(0, 1), 1);
  geometry.setIndex(new BufferAttribute(shown.triangles, 1));
  geometry.computeBoundingBox();
  const box = geometry.boundingBox!;
  const centre = box.getCenter(new Vector3());
  const material = surfaceMaterial(posed, texture);
  if (shown !== posed && posed.light) moveLight(material, posed, centre);
  return { mesh: new Mesh(geometry, material), centre, height: box.max.y - box.min.y };
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
