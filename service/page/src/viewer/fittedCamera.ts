// The camera of a fit, where its picture lies in the middle of a canvas, as large as that allows; and the way from there to another.
import { Matrix4, PerspectiveCamera, Quaternion, Vector3 } from "three";
import type { GlbBody, GlbCamera } from "./glb";

const NEAR_M = 0.02;
const FAR_M = 100;

/** The pinhole of the fit: at the origin, along -z, its centre where the picture's is. `aspect` is the canvas'. */
export function fittedProjection({ fx, cx, cy, width, height }: GlbCamera, aspect: number): Matrix4 {
  const beside = Math.max(0, (height * aspect - width) / 2);
  const above = Math.max(0, (width / aspect - height) / 2);
  const at = (pixels: number) => (pixels / fx) * NEAR_M;
  return new Matrix4().makePerspective(at(-cx - beside), at(width - cx + beside), at(cy + above), at(cy - height - above), NEAR_M, FAR_M);
}

/** Seconds: over its picture a body stands still, then it comes out of it. */
const STILL_S = 0.6;
const COMING_S = 1.4;

export class Emerging {
  private readonly camera = new PerspectiveCamera();
  private readonly origin = new Vector3();
  private readonly turned = new Quaternion();
  private began: number | null = null;

  /** The body is shown upright, so that the camera that took the picture is tilted. */
  constructor(
    private readonly fitted: GlbCamera,
    { upright }: Pick<GlbBody, "upright">,
  ) {
    if (upright) this.turned.fromArray(upright);
  }

  /** Whether it is over, `now` in milliseconds of a clock that began at any time. */
  isOver(now: number): boolean {
    return this.began !== null && this.share(now) === 1;
  }

  /** On the way to another camera. */
  at(now: number, to: PerspectiveCamera): PerspectiveCamera {
    this.began ??= now;
    const share = this.share(now);
    const { camera } = this;
    camera.position.lerpVectors(this.origin, to.position, share);
    camera.quaternion.slerpQuaternions(this.turned, to.quaternion, share);
    const from = fittedProjection(this.fitted, to.aspect).elements;
    camera.projectionMatrix.fromArray(to.projectionMatrix.elements.map((element, i) => from[i]! + share * (element - from[i]!)));
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    return camera;
  }

  /** From 0 to 1, slowly at both ends. */
  private share(now: number): number {
    const share = Math.min(1, Math.max(0, (now - this.began!) / 1000 - STILL_S) / COMING_S);
    return share * share * (3 - 2 * share);
  }
}
