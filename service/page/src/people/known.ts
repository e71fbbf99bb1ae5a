// The people whom the service knows, to be suggested and to choose among.
import { signal } from "@preact/signals";
import { listPeople } from "../api/calls";
import { ProblemError } from "../api/client";

export const knownLabels = signal<readonly string[]>([]);

/** Look anew; a service that does not tell leaves the list as it was. */
export async function lookForPeople(): Promise<void> {
  try {
    knownLabels.value = (await listPeople()).map(({ label }) => label);
  } catch (error) {
    if (!(error instanceof ProblemError)) throw error;
  }
}
