// What the service says of a picture, for somebody who clicks nothing and sends no requests: without fields, boxes and points.
import { wordFor } from "../messages/words";
import { messages } from "../messages";
import { answered } from "../ui/answered";

type Told = "faults" | "verdicts" | "warnings";

/** Null where the service's own words are to be shown. */
export function plainly(kind: Told, code: string): string | null {
  return wordFor(messages.measure.told[kind], code) ?? answered(kind, code);
}
