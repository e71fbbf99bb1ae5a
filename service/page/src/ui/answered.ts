// What the page says of an answer by its code; null where the service's own words are to be shown.
import type { Remark } from "../api/types";
import { messages } from "../messages";
import { plainName, wordFor } from "../messages/words";

export function answered(kind: keyof typeof messages.answers, code: string): string | null {
  return wordFor(messages.answers[kind], code);
}

/** A remark in the page's words, or in the service's. */
export function remarked({ code, reason, remedy }: Remark): string {
  return answered("remarks", code) ?? `${reason} ${remedy}`;
}

/** `views.1.points.left_hip` as a person says it. */
export function fieldName(field: string): string {
  const { fit, frame, measures, points } = messages;
  const words: Readonly<Record<string, string>> = { ...points.labels, ...measures.labels, ...frame.fields };
  const [, number, within = ""] = /^(?:views\.(\d+)\.?)?(.*)$/.exec(field) ?? [];
  const own = within.replace(/^(points|measurements)\./, "").replace(/\.(value|standard_error)$/, "");
  const named = wordFor(words, own) ?? plainName(own);
  return number === undefined ? named : [fit.picture(Number(number) + 1), named].filter(Boolean).join(", ");
}
