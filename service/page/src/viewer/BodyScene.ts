// The body in WebGL: over its picture by the fitted camera, or turned freely.
import { Scene, Vector3, WebGLRenderer } from "three";
import type { BufferAttribute } from "three";
import { NO_FLIPS } from "../flip/flips";
import type { Flips, TurnedLimb } from "../flip/flips";
import { facingOf } from "./facing";
import { fittedProjection } from "./fittedCamera";
import { Floor } from "./Floor";
import { calmNormals } from "./calm";
import type { GlbBody } from "./glb";
import { bodyPart } from "./bodyPart";
import type { Part } from "./bodyPart";
import { SURFACES } from "./surface";
import type { Surface } from "./surface";
import { Tapes } from "./Tapes";
import type { TapeEnds, TapeLines } from "./Tapes";
import { SIDES, TURNED_FOV_DEG, Turntable } from "./Turntable";
import type { Side } from "./Turntable";

export type Placement = "picture" | "turned" | "canonical";

/** Radians: a body measured is seen a little from aside, so that it has depth. */
const FROM_ASIDE = 0.35;

/** Loaded when the body is there, not with it. */
export type LimbTools = typeof import("../flip/limbs");

export class BodyScene {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly table: Turntable;
  private readonly posed: Part;
  private readonly canonical: Part | null;
  private kind: Surface = "lit";
  private marked: string | null = null;
  private readonly tapes: Tapes;
  private readonly floor = new Floor();
  /** Where the posed body faces, radians to the right of +z. */
  private readonly facing: number;
  private onTapes: ((ends: readonly TapeEnds[]) => void) | null = null;
  private placement: Placement = "picture";
  private limbTools: LimbTools | null = null;
  private flips: Flips = NO_FLIPS;
  private pointedAt: TurnedLimb | null = null;
  private isOther = false;
  private scheduled = 0;
  /** Nothing is drawn before the canvas' size is known: it would be shown stretched. */
  private isSized = false;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly body: GlbBody,
    private readonly upright: GlbBody | null,
    tapes: TapeLines,
  ) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(0, 0);
    this.posed = bodyPart(body, body);
    this.canonical = upright && bodyPart(upright, body);
    for (const { mesh } of this.parts()) this.scene.add(mesh);
    this.tapes = new Tapes(tapes);
    this.scene.add(this.tapes.group, this.floor.mesh);
    this.facing = facingOf(body, upright);
    this.table = new Turntable(canvas, () => this.draw());
    this.place("picture");
  }

  /** Where the body stands, and whence it is looked at. */
  place(placement: Placement): void {
    this.placement = placement;
    this.reveal();
    this.table.enabled = placement !== "picture";
    // Over the picture there is nothing to turn; elsewhere a finger turns sideways, and up and down it scrolls the page.
    this.renderer.domElement.style.touchAction = placement === "picture" ? "auto" : "pan-y";
    if (placement !== "picture") {
      this.setUpright();
      this.table.lookAt(this.shown(), placement === "canonical" ? FROM_ASIDE : 0);
      this.layFloor();
    }
    this.draw();
  }

  /** Look at the body from a side of its own; nothing over the picture. */
  lookFrom(side: Side): void {
    if (this.placement === "picture") return;
    const facing = this.placement === "canonical" ? 0 : this.facing;
    this.table.lookAt(this.shown(), facing + SIDES[side]);
    this.draw();
  }

  /** Tell where on the canvas the tapes lie, whenever it is drawn; none while they are hidden. */
  followTapes(tell: (ends: readonly TapeEnds[]) => void): void {
    this.onTapes = tell;
    this.draw();
  }

  surface(kind: Surface): void {
    this.kind = kind;
    for (const each of this.parts()) each.mesh.material.uniforms.surface!.value = SURFACES.indexOf(kind);
    this.draw();
  }

  /** The upright body in another shape of the same mesh, which no tape was laid about; null for its own. */
  shapeUpright(other: GlbBody | null): void {
    const shape = other ?? this.upright;
    if (!this.canonical || !shape) return;
    const { geometry } = this.canonical.mesh;
    for (const [name, values] of [["position", shape.positions], ["normal", shape.normals], ["calm", calmNormals(shape)]] as const) {
      const attribute = geometry.getAttribute(name) as BufferAttribute;
      attribute.array = values;
      attribute.needsUpdate = true;
    }
    this.isOther = other !== null;
    this.reveal();
    this.draw();
  }

  /** Let the tape of a measurement stand out. */
  mark(measurement: string | null): void {
    this.marked = measurement;
    this.tapes.mark(measurement);
    this.draw();
  }

  /** From now on limbs can be found and turned. */
  useLimbs(tools: LimbTools): void {
    this.limbTools = tools;
    this.turnLimbs(this.flips);
  }

  /** The posed body with these limbs turned. */
  turnLimbs(flips: Flips): void {
    this.flips = flips;
    this.limbTools?.reshape(this.posed.mesh, this.limbTools.bent(this.body, flips) ?? this.body);
    if (this.placement === "turned") this.layFloor();
    this.markLimb(this.pointedAt);
  }

  /** Let a limb of the posed body stand out. */
  markLimb(limb: TurnedLimb | null): void {
    this.pointedAt = limb;
    this.limbTools?.markLimbs(this.posed.mesh, limb, this.flips);
    this.draw();
  }

  /** The limb at a place of the window, where one can be turned. */
  limbAt(clientX: number, clientY: number): TurnedLimb | null {
    const { mesh } = this.posed;
    if (!this.limbTools || this.shown().mesh !== mesh) return null;
    const { left, top, width, height } = this.renderer.domElement.getBoundingClientRect();
    return this.limbTools.limbUnder(mesh, this.table.camera, (2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.table.aspect = width / height;
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
    this.tapes.dispose();
    this.floor.dispose();
    for (const each of this.parts()) {
      each.mesh.geometry.dispose();
      each.mesh.material.dispose();
    }
    this.renderer.dispose();
  }

  private shown(): Part {
    return this.placement === "canonical" && this.canonical ? this.canonical : this.posed;
  }

  private parts(): Part[] {
    return this.canonical ? [this.posed, this.canonical] : [this.posed];
  }

  private reveal(): void {
    const shown = this.shown();
    for (const each of this.parts()) each.mesh.visible = each === shown;
    this.tapes.group.visible = shown === this.canonical && !this.isOther;
    // Where the camera's tilt is not known, the posed body does not stand on anything.
    this.floor.mesh.visible = this.placement === "canonical" || (this.placement === "turned" && this.body.upright !== null);
  }

  private layFloor(): void {
    const { mesh, centre } = this.shown();
    const places = mesh.geometry.getAttribute("position");
    const vertices = Array.from({ length: places.count }, (_, i) => new Vector3().fromBufferAttribute(places, i).applyMatrix4(mesh.matrixWorld));
    this.floor.layUnder(vertices, centre);
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
    const { clientWidth, clientHeight } = this.renderer.domElement;
    this.onTapes?.(this.tapes.group.visible ? this.tapes.endsOn(camera, clientWidth, clientHeight) : []);
    const { dataset } = this.renderer.domElement;
    dataset.shows = [this.placement, this.kind, this.marked ?? "none"].join(" ");
    if (this.limbTools) dataset.limbs = [this.pointedAt ?? "none", ...Object.entries(this.flips).flat()].join(" ");
  }

  /** Over its picture the body is in the camera's axes; turned, it stands as gravity has it. */
  private setUpright(): void {
    const { mesh, centre } = this.posed;
    mesh.quaternion.identity();
    if (this.placement === "turned" && this.body.upright) mesh.quaternion.fromArray(this.body.upright);
    mesh.position.copy(centre).sub(centre.clone().applyQuaternion(mesh.quaternion));
    mesh.updateMatrixWorld();
  }

  private useFreeCamera(): void {
    this.table.camera.fov = TURNED_FOV_DEG;
    this.table.camera.updateProjectionMatrix();
  }

  private useFittedCamera(): void {
    const { camera } = this.body;
    if (!camera) return;
    const fitted = this.table.camera;
    fitted.position.set(0, 0, 0);
    fitted.quaternion.identity();
    fitted.updateMatrixWorld();
    fitted.projectionMatrix.copy(fittedProjection(camera, fitted.aspect));
    fitted.projectionMatrixInverse.copy(fitted.projectionMatrix).invert();
  }
}
