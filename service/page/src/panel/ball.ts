// A ball as Eq. 1 lights it, and the light that is brightest where a finger points.
import type { LightGuess } from "../api/types";

/** Azimuth and elevation of the light that is brightest at a spot of the ball's face, in [-1, 1]. */
export function lightAt(x: number, y: number): { azimuth_deg: number; elevation_deg: number } {
  const length = Math.max(1, Math.hypot(x, y));
  const [right, up] = [x / length, -y / length];
  const near = Math.sqrt(Math.max(0, 1 - right * right - up * up));
  return { azimuth_deg: degrees(Math.atan2(right, near)), elevation_deg: degrees(Math.asin(up)) };
}

/** Eq. 1 on a sphere: ambient, Lambert, and a highlight. */
export function drawBall(canvas: HTMLCanvasElement, guess: LightGuess | null): void {
  const context = canvas.getContext("2d")!;
  const { width } = canvas;
  const image = context.createImageData(width, width);
  const [azimuth, elevation] = [radians(guess?.azimuth_deg ?? 0), radians(guess?.elevation_deg ?? 0)];
  const toLight = [
    Math.cos(elevation) * Math.sin(azimuth),
    Math.sin(elevation),
    Math.cos(elevation) * Math.cos(azimuth),
  ] as const;
  const half = normalised([toLight[0], toLight[1], toLight[2] + 1]);
  const [ambient, albedo, gloss] = guess ? [0.06, 0.62, 0.28] : [0.3, 0.22, 0];
  const radius = width / 2 - 1;
  for (let row = 0; row < width; row++) {
    for (let column = 0; column < width; column++) {
      const x = (column + 0.5 - width / 2) / radius;
      const y = (width / 2 - row - 0.5) / radius;
      const squared = x * x + y * y;
      const edge = Math.min(1, Math.max(0, (1 - Math.sqrt(squared)) * radius + 0.5));
      if (edge === 0) continue;
      const normal = [x, y, Math.sqrt(Math.max(0, 1 - squared))] as const;
      const facing = dot(toLight, normal);
      const shade = facing > 0 ? albedo * facing + gloss * dot(half, normal) ** 40 : 0;
      const level = 255 * Math.min(1, ambient + shade) ** (1 / 2.2);
      image.data.set([level, level * 0.965, level * 0.92, 255 * edge], 4 * (row * width + column));
    }
  }
  context.putImageData(image, 0, 0);
}

type Three = readonly [number, number, number];

function dot(a: Three, b: Three): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function normalised(v: Three): Three {
  const length = Math.hypot(...v) || 1;
  return [v[0] / length, v[1] / length, v[2] / length];
}

function degrees(angle: number): number {
  return (angle * 180) / Math.PI;
}

function radians(angle: number): number {
  return (angle * Math.PI) / 180;
}
