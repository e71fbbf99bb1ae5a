// What can be done with a finished fit: keep its link, change it, erase it.
import { useSignal } from "@preact/signals";
import { eraseFit } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Fit } from "../api/fits";
import type { Problem } from "../api/types";
import type { Picture } from "../draft/picture";
import { forget } from "../history/store";
import { messages } from "../messages";
import { beginning, go } from "../route";
import { announce } from "../ui/announce";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { useQuestion } from "../ui/question";
import { changeAgain } from "./again";

const COPIED_MS = 2000;

export function Actions({ fit, pictures }: { fit: Fit; pictures: readonly Picture[] }) {
  const { fit: { of }, result: words } = messages;
  const own = of[fit.kind];
  const problem = useSignal<Problem | null>(null);
  const copied = useSignal(false);
  const question = useQuestion();
  const attempt = async (what: () => Promise<void>) => {
    try {
      await what();
      problem.value = null;
    } catch (error) {
      problem.value = problemFrom(error);
    }
  };
  const copy = () =>
    attempt(async () => {
      await navigator.clipboard.writeText(location.href);
      announce(words.linkCopied);
      copied.value = true;
      setTimeout(() => (copied.value = false), COPIED_MS);
    });
  const erase = () =>
    attempt(async () => {
      await eraseFit(fit);
      forget(fit.id);
      go(beginning(fit.kind));
    });
  return (
    <div class="submit">
      {problem.value && <ProblemNote problem={problem.value} />}
      {question.isAsked ? (
        <div class="submit-row" role="group" aria-label={own.deleteQuestion}>
          <span class="grow">{own.erase}</span>
          <button class="button" type="button" ref={question.refusal} onClick={question.leave}>
            {words.keep}
          </button>
          <button class="button is-danger" type="button" onClick={erase}>
            {words.delete}
          </button>
        </div>
      ) : (
        <div class="submit-row">
          <button
            class="button grow"
            type="button"
            disabled={pictures.length === 0}
            onClick={() => attempt(() => changeAgain(fit, pictures))}
          >
            {own.again}
          </button>
          <IconButton icon={copied.value ? "check" : "link"} label={copied.value ? words.copied : own.copy} onClick={copy} />
          <IconButton icon="trash" label={own.delete} onClick={question.ask} buttonRef={question.asker} />
        </div>
      )}
    </div>
  );
}
