// A picture that somebody chose: from a file, the clipboard or a camera. What cannot be fitted is told at once.
import { messages } from "../messages";
import { fitting } from "./fitting";
import { openHeic } from "./heic";
import { asJpeg, small } from "./jpeg";
import { shownPicture } from "./picture";
import type { Picture } from "./picture";
import { isWhole, kindOf } from "./whole";

/** Raises an Error that says what to do where the file cannot be shown, or cannot be fitted. */
export async function openPicture(file: Blob, name: string): Promise<Picture> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const kind = kindOf(bytes);
  if (kind === "heic") return openHeic(file, name, bytes);
  if (!isWhole(bytes, kind)) throw new Error(messages.start.cutOff(name));
  const shown = await shownPicture(file, name);
  return fitting(shown, () => (kind === null ? asJpeg(shown, bytes) : small(shown, bytes)));
}
