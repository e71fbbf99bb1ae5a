// Words by names that come from elsewhere.

/** A message by its name; null where there is none. */
export function wordFor(words: Readonly<Record<string, string>>, name: string): string | null {
  return Object.hasOwn(words, name) ? words[name]! : null;
}

/** A name nobody has words for, so that it can be read all the same. */
export function plainName(name: string): string {
  return name.replaceAll("_", " ");
}
