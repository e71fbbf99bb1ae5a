// Erase all of a person, once it is asked twice.
import { useSignal } from "@preact/signals";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { messages } from "../messages/language";
import { go } from "../route";
import { announce } from "../ui/announce";
import { ProblemNote } from "../ui/ProblemNote";
import { erasePerson } from "./records";

export function EraseAll({ label, fits, scans }: { label: string; fits: number; scans: number }) {
  const { frame, people: words, result } = messages.value;
  const asked = useSignal(false);
  const erasing = useSignal(false);
  const problem = useSignal<Problem | null>(null);
  const erase = async () => {
    erasing.value = true;
    problem.value = null;
    try {
      await erasePerson(label);
      announce(words.erased(label));
      go("#/");
    } catch (error) {
      problem.value = problemFrom(error);
    } finally {
      erasing.value = false;
    }
  };
  return (
    <section class="erase-all" aria-label={words.erase(label)}>
      {problem.value && <ProblemNote problem={problem.value} />}
      {asked.value ? (
        <div role="group" aria-label={words.erase(label)}>
          <p>{words.eraseQuestion(words.has(fits, scans))}</p>
          <div class="row">
            <button class="button" type="button" disabled={erasing.value} onClick={() => (asked.value = false)}>
              {result.keep}
            </button>
            <button class="button is-danger" type="button" disabled={erasing.value} onClick={() => void erase()}>
              {erasing.value ? frame.sending : result.delete}
            </button>
          </div>
        </div>
      ) : (
        <button class="button" type="button" onClick={() => (asked.value = true)}>
          {words.erase(label)}
        </button>
      )}
    </section>
  );
}
