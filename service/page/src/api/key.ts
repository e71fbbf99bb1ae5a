// The API key, where the service wants one: kept for this tab only.
import { signal } from "@preact/signals";
import { keep, kept } from "../kept";

const PLACE = "maquette.key";

export const apiKey = signal<string | null>(kept(PLACE, "sessionStorage"));

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
  apiKey.value = key;
  keyQuestion.value = null;
  const resumed = waiting;
  waiting = [];
  for (const resume of resumed) resume();
}
