// A body by itself on a floor, to be turned: with its texture, or as clay; it may turn by itself.
import {
  AmbientLight,
  Box3,
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SRGBColorSpace,
  Scene,
  Texture,
  Vector3,
  WebGLRenderer,
} from "three";
import { Floor } from "./Floor";
import { calmNormals } from "./calm";
import type { GlbBody, GlbCamera } from "./glb";
import { momentOf } from "./motion";
import type { Motion } from "./motion";
import { Emerging } from "./fittedCamera";
import { SIDES, Turntable } from "./Turntable";
import type { Side } from "./Turntable";

/** Of the vertices of a body in motion, by which its shadow is drawn. */
const EVERY_NTH = 6;
const CLAY = 0xdfd3c5;
/** A little from the left, so that a form that is lit shows its relief. */
const KEY_FROM = new Vector3(-0.5, 0.6, 1);

interface View {
  /** From where it is seen first, radians to the right of +z; null is from where the camera stood. */
  readonly azimuth: number | null;
  /** Where it faces, radians to the right of +z. */
  readonly facing: number;
  /** Whether it stands on something: not where the camera's tilt is not known. */
  readonly stands: boolean;
}

export class DerivedScene {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly table: Turntable;
  private readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial | MeshLambertMaterial>;
  private readonly floor: Floor | null;
  private motion: Motion | null = null;
  private emerging: Emerging | null = null;
  private scheduled = 0;
  /** Nothing is drawn before the canvas' size is known: it would be shown stretched. */
  private isSized = false;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly body: GlbBody,
    private readonly image: ImageBitmap | null,
    private readonly view: View,
  ) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(0, 0);
    this.mesh = new Mesh(geometryOf(image ? body : { ...body, normals: calmNormals(body) }), materialOf(body, image));
    // Not its vertices: they are others' as well.
    if (body.upright) this.mesh.quaternion.fromArray(body.upright);
    this.table = new Turntable(canvas, () => this.draw());
    // A finger turns sideways; up and down it scrolls the page, which the canvas may fill.
    canvas.style.touchAction = "pan-y";
    const key = new DirectionalLight(0xffffff, 2.2);
    key.position.copy(KEY_FROM);
    this.table.camera.add(key);
    this.scene.add(this.mesh, this.table.camera, new AmbientLight(0xffffff, 0.9));
    this.floor = view.stands ? new Floor() : null;
    if (this.floor) {
      this.scene.add(this.floor.mesh);
      this.layFloor();
    }
    this.lookFrom(view.azimuth);
  }

  /** Another shape of the same mesh. */
  reshape({ positions, normals }: Pick<GlbBody, "positions" | "normals">): void {
    const { geometry } = this.mesh;
    for (const [name, values] of [["position", positions], ["normal", normals]] as const) {
      // Not its array: it is others' as well.
      const attribute = geometry.getAttribute(name) as BufferAttribute;
      attribute.array = values;
      attribute.needsUpdate = true;
    }
    this.draw();
  }

  /** From now on it can be shown in the moments of a motion. */
  take(motion: Motion): void {
    const { geometry } = this.mesh;
    geometry.morphTargetsRelative = true;
    geometry.morphAttributes.position = motion.targets.map(({ positions }) => new BufferAttribute(positions, 3));
    geometry.morphAttributes.normal = motion.targets.map(({ normals }) => new BufferAttribute(normals, 3));
    this.mesh.updateMorphTargets();
    this.motion = motion;
    this.showMoment(0);
    this.lookFrom(this.view.azimuth);
  }

  /** As it is so many seconds from the motion's beginning. It stays where it is looked at, and the floor passes under it. */
  showMoment(seconds: number): void {
    if (!this.motion) return;
    const { weights, place: [x, y, z], rotation } = momentOf(this.motion, seconds);
    this.mesh.morphTargetInfluences!.splice(0, weights.length, ...weights);
    this.mesh.quaternion.fromArray(rotation).normalize();
    this.mesh.position.set(0, y!, 0);
    this.floor?.passUnder(x!, z!);
    this.layFloor(EVERY_NTH);
    this.draw();
  }

  /** The whole body from a side of its own. */
  lookAtSide(side: Side): void {
    this.lookFrom(this.view.facing + SIDES[side]);
    this.draw();
  }

  /** Turn once round by itself, unless somebody turns it. */
  turnOnce(): void {
    this.table.turnOnce();
  }

  /** Come out of the picture that this camera took and that lies below the canvas, then turn once. */
  emerge(camera: GlbCamera): void {
    this.emerging = new Emerging(camera, this.body);
    this.table.enabled = false;
    this.draw();
  }

  turnBy(key: string): boolean {
    return this.table.turnBy(key);
  }

  /** The whole as it is turned, as a picture of that height on the page's ground; the canvas keeps nothing between two draws. */
  seen(height = this.renderer.domElement.height): HTMLCanvasElement {
    const { domElement } = this.renderer;
    this.renderer.render(this.scene, this.table.camera);
    const picture = document.createElement("canvas");
    const scale = height / domElement.height;
    [picture.width, picture.height] = [Math.round(scale * domElement.width), height];
    const context = picture.getContext("2d")!;
    context.fillStyle = getComputedStyle(domElement).getPropertyValue("--room");
    context.fillRect(0, 0, picture.width, height);
    context.drawImage(domElement, 0, 0, picture.width, height);
    this.render();
    return picture;
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.table.aspect = width / height;
    this.isSized = true;
    // At once: another size has emptied the canvas.
    this.render();
  }

  dispose(): void {
    cancelAnimationFrame(this.scheduled);
    this.table.dispose();
    this.floor?.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.map?.dispose();
    this.mesh.material.dispose();
    this.image?.close();
    this.renderer.dispose();
  }

  private lookFrom(azimuth: number | null): void {
    const box = new Box3().setFromObject(this.mesh, true);
    const centre = box.getCenter(new Vector3());
    // The camera stood at the origin.
    this.table.lookAt({ centre, size: box.getSize(new Vector3()) }, azimuth ?? Math.atan2(-centre.x, -centre.z));
  }

  private layFloor(every = 1): void {
    if (!this.floor) return;
    this.mesh.updateMatrixWorld();
    const count = Math.floor(this.mesh.geometry.getAttribute("position").count / every);
    const vertices = Array.from({ length: count }, (_, i) => this.mesh.getVertexPosition(every * i, new Vector3()).applyMatrix4(this.mesh.matrixWorld));
    // What moves keeps its floor: the ground is at y = 0.
    const centre = this.motion ? new Vector3() : new Box3().setFromPoints(vertices).getCenter(new Vector3());
    this.floor.layUnder(vertices, centre, this.motion ? 0 : undefined);
  }

  private draw(): void {
    cancelAnimationFrame(this.scheduled);
    this.scheduled = requestAnimationFrame(() => this.render());
  }

  private render(): void {
    if (!this.isSized) return;
    const now = performance.now();
    const { emerging } = this;
    if (this.floor) this.floor.mesh.visible = emerging === null;
    this.renderer.render(this.scene, emerging?.at(now, this.table.camera) ?? this.table.camera);
    if (emerging) this.draw();
    if (emerging?.isOver(now)) {
      this.emerging = null;
      this.table.enabled = true;
      this.turnOnce();
    }
    this.renderer.domElement.dataset.shows = this.mesh.material.map ? "texture" : "clay";
  }
}

function geometryOf(body: GlbBody): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(body.positions, 3));
  geometry.setAttribute("normal", new BufferAttribute(body.normals, 3));
  if (body.uv) geometry.setAttribute("uv", new BufferAttribute(body.uv, 2));
  geometry.setIndex(new BufferAttribute(body.triangles, 1));
  return geometry;
}

/** A photograph has its light in it; an albedo, and clay, need one. */
function materialOf(body: GlbBody, image: ImageBitmap | null): MeshBasicMaterial | MeshLambertMaterial {
  if (!image) return new MeshLambertMaterial({ color: CLAY });
  const map = new Texture(image);
  map.flipY = false;
  map.colorSpace = SRGBColorSpace;
  map.needsUpdate = true;
  return body.unlit ? new MeshBasicMaterial({ map }) : new MeshLambertMaterial({ map });
}
