// What a scan's views are called.
import type { ScanResult } from "../api/types";
import { capitalised } from "../messages/figures";
import { messages } from "../messages/language";

export type ViewName = ScanResult["views"][number]["view"];

export function viewLabel(view: ViewName): string {
  return messages.value.measure.views[view].label;
}

/** Within a sentence, without its article. */
export function pictureOf(view: ViewName): string {
  return messages.value.measure.views[view].picture;
}

/** As a heading, or before what is said of it. */
export function pictureTitle(view: ViewName): string {
  return capitalised(pictureOf(view));
}
