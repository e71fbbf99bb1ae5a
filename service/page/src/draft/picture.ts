// A picture that somebody chose, as this browser shows it.
import { getPicture, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { UploadedImage } from "../api/types";
import { messages } from "../messages";
import { answered } from "../ui/answered";

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
}

/** A file as a picture; an Error says what to do where neither this browser nor the service can show it. */
export async function openPicture(file: Blob, name: string): Promise<Picture> {
  return (await shownPicture(file, name).catch(() => null)) ?? byService(file, name);
}

/** An Error where the browser cannot show the file. */
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
  return { name, file, shown, url, element, width, height, kept: null };
}

/** HEIC, what phones take and most browsers do not show: the service has it as it is, and gives it back as a JPEG. */
async function byService(file: Blob, name: string): Promise<Picture> {
  try {
    const kept = await uploadImage(file, new AbortController().signal);
    return { ...(await shownPicture(file, name, await getPicture(`/v1/images/${kept.id}/picture`))), kept };
  } catch (error) {
    const problem = problemFrom(error);
    if (!problem) throw error;
    const [first = problem] = problem.errors ?? [];
    throw new Error(messages.frame.ofField(name, answered("faults", first.code) ?? problem.detail));
  }
}
