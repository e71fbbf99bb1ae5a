// What every language has to say. The English catalogue is the pattern: another one with a message too few,
// too many or of other parameters is a fault of types.
import type { Answers } from "./answers";
import type { en } from "./en";

type Worded<T> = T extends string
  ? string
  : T extends (...parameters: infer P) => string
    ? (...parameters: P) => string
    : { readonly [K in keyof T]: Worded<T[K]> };

export type Messages = Worded<Omit<typeof en, "answers">> & { readonly answers: Answers };

/** A message by a name that comes from elsewhere; null where there is none. */
export function wordFor(words: Readonly<Record<string, string>>, name: string): string | null {
  return Object.hasOwn(words, name) ? words[name]! : null;
}

/** A name nobody has words for, so that it can be read all the same. */
export function plainName(name: string): string {
  return name.replaceAll("_", " ");
}
