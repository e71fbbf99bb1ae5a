// What is to become of limbs that were turned: a new fit, or nothing.
import { useSignal } from "@preact/signals";
import { problemFrom } from "../api/client";
import type { Fit, Problem, ViewResult } from "../api/types";
import { messages } from "../messages";
import { fitWithFlips } from "../result/again";
import { ProblemNote } from "../ui/ProblemNote";
import type { FlipsOfViews } from "./flips";
import { inWords } from "./words";

interface Props {
  readonly fit: Fit;
  readonly views: readonly ViewResult[];
  readonly flips: FlipsOfViews;
  readonly onTakeBack: () => void;
}

export function PreviewBar({ fit, views, flips, onTakeBack }: Props) {
  const { frame, limbs: words } = messages;
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  const send = async () => {
    sending.value = true;
    problem.value = null;
    try {
      await fitWithFlips(fit, flips);
    } catch (error) {
      problem.value = problemFrom(error);
    } finally {
      sending.value = false;
    }
  };
  return (
    <div class="submit is-preview">
      {problem.value && <ProblemNote problem={problem.value} />}
      <p class="fine">{words.preview(inWords(flips, views))}</p>
      <div class="submit-row">
        <button class="button" type="button" onClick={onTakeBack}>
          {words.takeBack}
        </button>
        <button class="button is-primary grow" type="button" disabled={sending.value} onClick={send}>
          {sending.value ? frame.sending : words.again}
        </button>
      </div>
    </div>
  );
}
