// The photograph and, beside it, the body that was found in it: by the same camera, at the same scale.
import type { ResultFiles } from "../result/files";
import { BodyScene } from "../viewer/BodyScene";
import type { GlbBody, GlbCamera } from "../viewer/glb";
import { pngOf, sheetOf } from "./sheet";

const HEIGHT = 1200;
/** Of the body's height, round it. */
const MARGIN = 0.08;
/** Of a frame that is drawn whole. */
const MOST_PX = 2400;
const BETWEEN_PX = 4;

export async function beforeAndAfter({ posed }: ResultFiles, picture: HTMLImageElement): Promise<File> {
  const camera = posed.camera!;
  const { left, top, width, height } = aroundBody(posed, camera);
  const scale = Math.min(HEIGHT / height, MOST_PX / Math.max(camera.width, camera.height));
  const [wide, high] = [Math.round(scale * width), Math.round(scale * height)];
  const stage = document.createElement("canvas");
  const scene = new BodyScene(stage, posed, null, picture, {});
  const sheet = sheetOf(2 * wide + BETWEEN_PX, high);
  try {
    scene.surface("clay");
    scene.resize(Math.round(scale * camera.width), Math.round(scale * camera.height));
    for (const [place, source, across, down] of [
      [0, picture, picture.naturalWidth, picture.naturalHeight],
      [wide + BETWEEN_PX, stage, stage.width, stage.height],
    ] as const) {
      const [x, y] = [across / camera.width, down / camera.height];
      sheet.context.drawImage(source, x * left, y * top, x * width, y * height, place, 0, wide, high);
    }
    return await pngOf(sheet, "before_and_after");
  } finally {
    scene.dispose();
  }
}

interface Frame {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

/** Of the picture, as large as the body with its margin, in the camera's pixels. */
export function aroundBody({ positions }: Pick<GlbBody, "positions">, { fx, cx, cy, width, height }: GlbCamera): Frame {
  let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3) {
    // The camera looks along -z.
    const depth = -positions[i + 2]!;
    const [u, v] = [cx + (fx * positions[i]!) / depth, cy - (fx * positions[i + 1]!) / depth];
    [left, right] = [Math.min(left, u), Math.max(right, u)];
    [top, bottom] = [Math.min(top, v), Math.max(bottom, v)];
  }
  const margin = MARGIN * (bottom - top);
  const [x, y] = [Math.max(0, left - margin), Math.max(0, top - margin)];
  return { left: x, top: y, width: Math.min(width, right + margin) - x, height: Math.min(height, bottom + margin) - y };
}
