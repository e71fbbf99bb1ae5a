// A camera that walks round a body: by dragging, wheel, pinch and keys.
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export const TURNED_FOV_DEG = 30;
const MARGIN = 1.24;
/** How near the camera may come to looking straight down or up, as a sine. */
const STEEPEST = 0.98;
const STEP = 0.12;
const SECONDS_PER_MINUTE = 60;
/** Once round, by itself. */
const TURN_S = 14;
const STEPS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-STEP, 0],
  ArrowRight: [STEP, 0],
  ArrowUp: [0, -STEP],
  ArrowDown: [0, STEP],
};

/** From where a body is looked at, as radians to the right of its front. */
export const SIDES = { front: 0, side: Math.PI / 2, back: Math.PI } as const;
export type Side = keyof typeof SIDES;

export interface Standing {
  readonly centre: Vector3;
  /** Along the axes. */
  readonly size: Vector3;
}

export class Turntable {
  readonly camera = new PerspectiveCamera(TURNED_FOV_DEG, 1, 0.02, 100);
  private readonly controls: OrbitControls;
  /** How the body is looked at, until somebody turns it. */
  private looked: readonly [Standing, number] | null = null;
  private turning = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    onChange: () => void,
  ) {
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", onChange);
    this.controls.addEventListener("start", () => this.taken());
  }

  /** Turn once round by itself, while it is shown, unless somebody turns it. */
  turnOnce(): void {
    this.controls.autoRotate = true;
    let left = TURN_S;
    this.controls.autoRotateSpeed = SECONDS_PER_MINUTE / TURN_S;
    let before = performance.now();
    const step = (now: number) => {
      if (this.looked && this.canvas.checkVisibility()) {
        const by = Math.min(left, (now - before) / 1000);
        this.controls.update(by);
        left -= by;
        // A step round the body is still the whole of it.
        this.looked = [this.looked[0], this.controls.getAzimuthalAngle()];
      }
      before = now;
      if (left > 0) this.turning = requestAnimationFrame(step);
      else this.controls.autoRotate = false;
    };
    this.turning = requestAnimationFrame(step);
  }

  set enabled(enabled: boolean) {
    this.controls.enabled = enabled;
  }

  /** Of the canvas; a body that nobody turned stays whole. */
  set aspect(aspect: number) {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (this.looked) this.lookAt(...this.looked);
  }

  /** The whole body, seen from so many radians to the right of its front. */
  lookAt(standing: Standing, azimuth: number): void {
    const { centre, size } = standing;
    const half = Math.tan((TURNED_FOV_DEG * Math.PI) / 360);
    const width = Math.abs(size.x * Math.cos(azimuth)) + Math.abs(size.z * Math.sin(azimuth));
    const distance = (MARGIN * Math.max(size.y, width / this.camera.aspect)) / 2 / half;
    this.looked = [standing, azimuth];
    this.camera.position.set(centre.x + distance * Math.sin(azimuth), centre.y, centre.z + distance * Math.cos(azimuth));
    this.controls.target.copy(centre);
    this.controls.minDistance = 0.2 * distance;
    this.controls.maxDistance = 3 * distance;
    this.controls.update();
  }

  /** Turn by an arrow key; false of any other key. */
  turnBy(key: string): boolean {
    const step = STEPS[key];
    if (!step) return false;
    const centre = this.controls.target;
    const offset = this.camera.position.clone().sub(centre);
    const side = new Vector3().crossVectors(this.camera.up, offset).normalize();
    offset.applyAxisAngle(this.camera.up, step[0]).applyAxisAngle(side, step[1]);
    if (Math.abs(offset.clone().normalize().y) <= STEEPEST) {
      this.taken();
      this.camera.position.copy(centre).add(offset);
      this.controls.update();
    }
    return true;
  }

  dispose(): void {
    cancelAnimationFrame(this.turning);
    this.controls.dispose();
  }

  /** Somebody turns it from now on. */
  private taken(): void {
    this.looked = null;
    this.controls.autoRotate = false;
    cancelAnimationFrame(this.turning);
  }
}
