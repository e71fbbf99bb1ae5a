// The camera of the browser: its stream, and a picture from it.
import { signal } from "@preact/signals";
import type { messages } from "../messages";

export type Side = "environment" | "user";

/** Whether the camera fills the window. */
export const isFilming = signal(false);

const JPEG_QUALITY = 0.95;
const PHOTO_WITHIN_MS = 4000;

/** Only where a page is served securely, or by this machine. */
export function hasCamera(): boolean {
  return navigator.mediaDevices?.getUserMedia !== undefined;
}

export function openCamera(side: Side): Promise<MediaStream> {
  return navigator.mediaDevices.getUserMedia({
    audio: false,
    video: { facingMode: { ideal: side }, width: { ideal: 2560 }, height: { ideal: 1920 } },
  });
}

export function closeCamera(stream: MediaStream | null): void {
  for (const track of stream?.getTracks() ?? []) track.stop();
}

/** What stands in the way of the camera. */
export type CameraTrouble = keyof typeof messages.measure.camera.troubles;

export function cameraTrouble(error: unknown): CameraTrouble {
  const name = error instanceof DOMException ? error.name : "";
  if (name === "NotAllowedError") return "forbidden";
  if (name === "NotFoundError" || name === "OverconstrainedError") return "none";
  if (name === "NotReadableError") return "used";
  return "unusable";
}

/** A full photograph where the browser takes one, which may name its lens; else what the video shows. */
export async function takePicture(stream: MediaStream, video: HTMLVideoElement): Promise<Blob> {
  const [track] = stream.getVideoTracks();
  if (track && "ImageCapture" in globalThis) {
    try {
      const photo = await within(new ImageCapture(track).takePhoto(), PHOTO_WITHIN_MS);
      // A photograph smaller than the video is none.
      if (await isAsLarge(photo, video)) return photo;
    } catch {
      // Some cameras announce photographs and take none.
    }
  }
  return frameOf(video);
}

async function isAsLarge(photo: Blob, video: HTMLVideoElement): Promise<boolean> {
  const image = await createImageBitmap(photo);
  const pixels = image.width * image.height;
  image.close();
  return pixels >= video.videoWidth * video.videoHeight;
}

function frameOf(video: HTMLVideoElement): Promise<Blob> {
  const canvas = document.createElement("canvas");
  canvas.width = video.videoWidth;
  canvas.height = video.videoHeight;
  canvas.getContext("2d")!.drawImage(video, 0, 0);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/jpeg", JPEG_QUALITY),
  );
}

function within<T>(promise: Promise<T>, ms: number): Promise<T> {
  return Promise.race([promise, new Promise<T>((_, reject) => setTimeout(() => reject(new Error("late")), ms))]);
}
