// What the page says of an answer by its code; null where the service's own words are to be shown.
import { messages } from "../messages";
import { wordFor } from "../messages/words";

export function answered(kind: keyof typeof messages.answers, code: string): string | null {
  return wordFor(messages.answers[kind], code);
}

/** `points.left_hip` as a person says it. */
export function fieldName(field: string): string {
  const { frame, measures, points } = messages;
  const words: Readonly<Record<string, string>> = { ...points.labels, ...measures.labels, ...frame.fields };
  const own = field.replace(/^(points|measurements)\./, "").replace(/\.(value|standard_error)$/, "");
  return Object.hasOwn(words, own) ? words[own]! : own.replaceAll("_", " ");
}
