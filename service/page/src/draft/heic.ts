// HEIC, what phones take and most browsers do not show: the service has it as it is, and gives it back as a JPEG to show.
import { getPicture, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import { messages } from "../messages";
import { answered } from "../ui/answered";
import { fitting } from "./fitting";
import { asJpeg } from "./jpeg";
import { shownPicture } from "./picture";
import type { Picture } from "./picture";

const NOT_DECODED = "heic-not-installed";

/** Raises an Error that says what to do where neither the service nor this browser can show it. */
export async function openHeic(file: Blob, name: string, bytes: Uint8Array): Promise<Picture> {
  let told: unknown;
  const decoded = await byService(file, name).catch((error: unknown) => {
    told = error;
    return null;
  });
  if (decoded) return fitting(decoded, async () => decoded);
  const shown = await shownPicture(file, name).catch(() => null);
  if (!shown) throw new Error(reason(name, told));
  return fitting(shown, () => asJpeg(shown, bytes));
}

async function byService(file: Blob, name: string): Promise<Picture> {
  const kept = await uploadImage(file, new AbortController().signal);
  return { ...(await shownPicture(file, name, await getPicture(`/v1/images/${kept.id}/picture`))), kept };
}

function reason(name: string, error: unknown): string {
  const problem = problemFrom(error);
  if (!problem) return String(error);
  const [first = problem] = problem.errors ?? [];
  if (first.code === NOT_DECODED) return messages.start.heic(name);
  return messages.frame.ofField(name, answered("faults", first.code) ?? problem.detail);
}
