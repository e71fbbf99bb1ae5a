// A body by itself, to be turned: with its texture, or as clay.
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
import type { GlbBody } from "./glb";
import { Turntable } from "./Turntable";

const CLAY = 0xdfd3c5;
/** A little from the left, so that a form that is lit shows its relief. */
const KEY_FROM = new Vector3(-0.5, 0.6, 1);

interface View {
  /** What sets the body upright; null of one that stands. */
  readonly upright: GlbBody["upright"];
  /** Radians to the right of its front. */
  readonly azimuth: number;
}

const FRONT: View = { upright: null, azimuth: 0 };

export class DerivedScene {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly table: Turntable;
  private readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial | MeshLambertMaterial>;
  private scheduled = 0;
  /** Nothing is drawn before the canvas' size is known: it would be shown stretched. */
  private isSized = false;

  constructor(canvas: HTMLCanvasElement, body: GlbBody, image: ImageBitmap | null, { upright, azimuth }: View = FRONT) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(0, 0);
    this.mesh = new Mesh(geometryOf(body), materialOf(body, image));
    // Not its vertices: they are others' as well.
    if (upright) this.mesh.quaternion.fromArray(upright);
    this.table = new Turntable(canvas, () => this.draw());
    // A finger turns sideways; up and down it scrolls the page, which the canvas may fill.
    canvas.style.touchAction = "pan-y";
    const key = new DirectionalLight(0xffffff, 2.2);
    key.position.copy(KEY_FROM);
    this.table.camera.add(key);
    this.scene.add(this.mesh, this.table.camera, new AmbientLight(0xffffff, 0.9));
    const box = new Box3().setFromObject(this.mesh, true);
    this.table.lookAt({ centre: box.getCenter(new Vector3()), size: box.getSize(new Vector3()) }, azimuth);
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

  turnBy(key: string): boolean {
    return this.table.turnBy(key);
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
    this.mesh.geometry.dispose();
    this.mesh.material.map?.dispose();
    this.mesh.material.dispose();
    this.renderer.dispose();
  }

  private draw(): void {
    cancelAnimationFrame(this.scheduled);
    this.scheduled = requestAnimationFrame(() => this.render());
  }

  private render(): void {
    if (!this.isSized) return;
    this.renderer.render(this.scene, this.table.camera);
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
