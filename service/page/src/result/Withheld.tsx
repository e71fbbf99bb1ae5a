// In place of measurements that are withheld: why, and a way to have them all the same.
import { useSignal } from "@preact/signals";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { messages } from "../messages";
import { ProblemNote } from "../ui/ProblemNote";

/** `onAnyway` asks once more, by force; null until it can. */
export function Withheld({ onAnyway }: { onAnyway: (() => Promise<void>) | null }) {
  const { frame, result: words } = messages;
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  const send = async () => {
    sending.value = true;
    problem.value = null;
    try {
      await onAnyway!();
    } catch (error) {
      problem.value = problemFrom(error);
    } finally {
      sending.value = false;
    }
  };
  return (
    <section class="section" aria-labelledby="measures-title">
      <h2 id="measures-title">{words.measurements}</h2>
      <p>{words.withheld}</p>
      {problem.value && <ProblemNote problem={problem.value} />}
      <button class="button" type="button" disabled={!onAnyway || sending.value} onClick={send}>
        {sending.value ? frame.sending : words.measureAnyway}
      </button>
    </section>
  );
}
