// A short film of a body that turns once; a picture of it where the browser films nothing.
import { DerivedScene } from "../viewer/DerivedScene";
import { readGlb } from "../viewer/glb";
import { getFile } from "../api/calls";
import { GROUND, pngOf, sheetOf } from "./sheet";
import type { Sheet } from "./sheet";

const NAME = "body_turning";
const [WIDTH, HEIGHT] = [720, 960];
/** Once round: devices take a file from a tap of at most five seconds ago. */
const TURN_S = 4;
const FRAMES_PER_SECOND = 30;
/** Of a film, however slow the device is: it then takes longer. */
const LEAST_FRAMES = 36;
const BITS_PER_SECOND = 4_000_000;
/** MP4 first: more programs show it. */
const TYPES = ["video/mp4;codecs=avc1.42E01F", "video/webm;codecs=vp9", "video/webm"];

interface Standing {
  /** Of the body's GLB. */
  readonly path: string;
  /** Where it faces, radians to the right of +z. */
  readonly facing: number;
  /** Whether it stands on something. */
  readonly stands: boolean;
}

export async function turningFilm({ path, facing, stands }: Standing): Promise<File> {
  const body = readGlb(await (await getFile(path)).arrayBuffer());
  const image = body.texture && (await createImageBitmap(body.texture));
  const stage = document.createElement("canvas");
  const scene = new DerivedScene(stage, body, image, { azimuth: facing, facing, stands });
  const sheet = sheetOf(WIDTH, HEIGHT);
  const paint = (turned: number) => {
    scene.turnTo(facing + 2 * Math.PI * turned);
    sheet.context.fillStyle = GROUND;
    sheet.context.fillRect(0, 0, WIDTH, HEIGHT);
    sheet.context.drawImage(stage, 0, 0, WIDTH, HEIGHT);
  };
  try {
    // The film's own pixels, not those of the screen.
    const density = Math.min(window.devicePixelRatio || 1, 2);
    scene.resize(WIDTH / density, HEIGHT / density);
    paint(0);
    const type = filmType(sheet);
    return (type && (await filmed(sheet, type, paint))) || (await pngOf(sheet, NAME));
  } finally {
    scene.dispose();
  }
}

/** Null where the browser cannot film a canvas. */
function filmType({ canvas }: Sheet): string | null {
  if (typeof MediaRecorder === "undefined" || !canvas.captureStream) return null;
  return TYPES.find((type) => MediaRecorder.isTypeSupported(type)) ?? null;
}

/** Null if nothing was recorded. */
async function filmed({ canvas }: Sheet, type: string, paint: (turned: number) => void): Promise<File | null> {
  const stream = canvas.captureStream(FRAMES_PER_SECOND);
  try {
    return await recorded(stream, type, paint);
  } finally {
    for (const track of stream.getTracks()) track.stop();
  }
}

async function recorded(stream: MediaStream, type: string, paint: (turned: number) => void): Promise<File | null> {
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: BITS_PER_SECOND });
  const pieces: Blob[] = [];
  recorder.ondataavailable = ({ data }) => pieces.push(data);
  const ended = new Promise<void>((resolve, reject) => {
    recorder.onstop = () => resolve();
    recorder.onerror = () => reject(new Error(type));
  });
  const started = new Promise<void>((resolve) => (recorder.onstart = () => resolve()));
  recorder.start();
  await started;
  await turned(paint);
  recorder.stop();
  await ended;
  if (pieces.every(({ size }) => size === 0)) return null;
  const [plain] = type.split(";") as [string];
  return new File(pieces, `${NAME}.${plain.slice("video/".length)}`, { type: plain });
}

/** Once round, in its time or slower. */
function turned(paint: (turned: number) => void): Promise<void> {
  return new Promise((resolve) => {
    let before = performance.now();
    let share = 0;
    const step = (now: number) => {
      share = Math.min(1, share + Math.min(1 / LEAST_FRAMES, Math.max(0, now - before) / 1000 / TURN_S));
      before = now;
      paint(share);
      if (share < 1) requestAnimationFrame(step);
      else resolve();
    };
    requestAnimationFrame(step);
  });
}
