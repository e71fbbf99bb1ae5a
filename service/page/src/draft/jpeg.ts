// A picture as a JPEG of this browser, upright, and small enough for the service.
import { getIndex } from "../api/calls";
import { messages } from "../messages";
import { focalLength35mm, withFocalLength } from "./exif";
import { shownPicture } from "./picture";
import type { Picture } from "./picture";

const QUALITY = 0.95;
/** What a service takes unless it is set up otherwise. */
const MOST_PIXELS = 50_000_000;
const MOST_BYTES = 50_000_000;
/** Of a form, beside the picture. */
const FRAME_BYTES = 10_000;
/** Larger than this the service is asked what it takes. It is plenty, and any browser's canvas has room for it. */
const SURELY_PIXELS = 12_000_000;
const SURELY_BYTES = 10_000_000;

/** The same picture, scaled down where the service would not take it. */
export async function small(picture: Picture, bytes: Uint8Array): Promise<Picture> {
  const pixels = picture.width * picture.height;
  if (pixels <= SURELY_PIXELS && bytes.length <= SURELY_BYTES) return picture;
  const index = await getIndex().catch(() => null);
  const most = index?.max_pixels ?? MOST_PIXELS;
  const isTaken = pixels <= most && bytes.length <= (index?.max_upload_bytes ?? MOST_BYTES) - FRAME_BYTES;
  return isTaken ? picture : asJpeg(picture, bytes, Math.min(most, SURELY_PIXELS));
}

/** Its pixels as a JPEG, with the lens that the file names. */
export async function asJpeg(picture: Picture, bytes: Uint8Array, mostPixels = SURELY_PIXELS): Promise<Picture> {
  const { element, name, url, width, height } = picture;
  const scale = Math.min(1, Math.sqrt(mostPixels / (width * height)));
  const canvas = document.createElement("canvas");
  canvas.width = Math.floor(scale * width);
  canvas.height = Math.floor(scale * height);
  const context = canvas.getContext("2d")!;
  context.imageSmoothingQuality = "high";
  context.fillStyle = "white";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(element, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(url);
  const plain = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/jpeg", QUALITY));
  if (!plain) throw new Error(messages.start.notConverted);
  const lens = focalLength35mm(bytes);
  const written = await shownPicture(lens === null ? plain : withFocalLength(plain, lens), name);
  return { ...written, scaledFrom: scale < 1 ? { width, height } : null };
}
