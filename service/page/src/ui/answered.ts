// What the page says of an answer by its code; null where the service's own words are to be shown.
import type { Answers } from "../messages/answers";
import { messages } from "../messages/language";

export function answered(kind: keyof Answers, code: string): string | null {
  const words: Readonly<Record<string, string | null>> = messages.value.answers[kind] ?? {};
  return Object.hasOwn(words, code) ? words[code]! : null;
}

/** `points.left_hip` as a person says it. */
export function fieldName(field: string): string {
  const { frame, measures, points } = messages.value;
  const words: Readonly<Record<string, string>> = { ...points.labels, ...measures.labels, ...frame.fields };
  const own = field.replace(/^(points|measurements)\./, "").replace(/\.(value|standard_error)$/, "");
  return Object.hasOwn(words, own) ? words[own]! : own.replaceAll("_", " ");
}
