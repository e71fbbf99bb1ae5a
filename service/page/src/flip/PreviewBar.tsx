// What is to become of limbs that were turned: a new fit, or nothing.
import { useSignal } from "@preact/signals";
import { problemFrom } from "../api/client";
import type { Job, Problem } from "../api/types";
import type { Picture } from "../draft/picture";
import { messages } from "../messages/language";
import { fitWithFlips } from "../result/again";
import { ProblemNote } from "../ui/ProblemNote";
import type { Flips } from "./flips";
import { inWords } from "./words";

interface Props {
  readonly job: Job;
  readonly picture: Picture | null;
  readonly flips: Flips;
  readonly onTakeBack: () => void;
}

export function PreviewBar({ job, picture, flips, onTakeBack }: Props) {
  const { frame, limbs: words } = messages.value;
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  const send = async () => {
    sending.value = true;
    problem.value = null;
    try {
      await fitWithFlips(picture!, job, flips);
    } catch (error) {
      problem.value = problemFrom(error);
    } finally {
      sending.value = false;
    }
  };
  return (
    <div class="submit is-preview">
      {problem.value && <ProblemNote problem={problem.value} />}
      <p class="fine">{words.preview(inWords(flips))}</p>
      <div class="submit-row">
        <button class="button" type="button" onClick={onTakeBack}>
          {words.takeBack}
        </button>
        <button class="button is-primary grow" type="button" disabled={!picture || sending.value} onClick={send}>
          {sending.value ? frame.sending : words.again}
        </button>
      </div>
    </div>
  );
}
