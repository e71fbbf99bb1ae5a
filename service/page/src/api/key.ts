// The API key, where the service wants one: kept for this tab only.
import { signal } from "@preact/signals";
import { keep, kept } from "../kept";

const PLACE = "maquette.key";

export const apiKey = signal<string | null>(kept(PLACE, "sessionStorage"));

/** The last key that the service took. */
export const accepted = signal<string | null>(null);

/** Why a key is asked for at this moment; null while none is. */
export const keyQuestion = signal<string | null>(null);

let waiting: (() => void)[] = [];

/** Ask the person for a key; resolves once there is a new one. */
export function askForKey(reason: string): Promise<void> {
  keyQuestion.value = reason;
  return new Promise((resolve) => waiting.push(resolve));
}

export function useKey(key: string): void {
  keep(PLACE, key, "sessionStorage");
  present(key);
}

/** From now on send this key, or a token in its place; it is kept nowhere. */
export function present(key: string | null): void {
  apiKey.value = key;
  keyQuestion.value = null;
  const resumed = waiting;
  waiting = [];
  for (const resume of resumed) resume();
}
