// A picture as this browser shows it.
import type { UploadedImage } from "../api/types";
import { messages } from "../messages";

export interface Picture {
  readonly name: string;
  /** What is uploaded. */
  readonly file: Blob;
  /** What is shown: the same, unless this browser cannot show it. */
  readonly shown: Blob;
  readonly url: string;
  readonly element: HTMLImageElement;
  readonly width: number;
  readonly height: number;
  /** What the service said of the file, where it has it already. */
  readonly kept: UploadedImage | null;
  /** How large the file was that this was scaled down from. */
  readonly scaledFrom: { readonly width: number; readonly height: number } | null;
}

/** Raises an Error that says what to do where the browser cannot show the file. */
export async function shownPicture(file: Blob, name: string, shown = file): Promise<Picture> {
  const url = URL.createObjectURL(shown);
  const element = new Image();
  element.src = url;
  try {
    await element.decode();
  } catch {
    URL.revokeObjectURL(url);
    throw new Error(messages.start.notShown(name));
  }
  const { naturalWidth: width, naturalHeight: height } = element;
  return { name, file, shown, url, element, width, height, kept: null, scaledFrom: null };
}
