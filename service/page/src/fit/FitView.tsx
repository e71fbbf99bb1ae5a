// One fit: on its way, ended without a result, or its result.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { cancelFit, getAsked, getPicture } from "../api/calls";
import { isUnreachable, problemFrom, untilReached } from "../api/client";
import type { Fit, FitRef } from "../api/fits";
import type { Problem } from "../api/types";
import { person } from "../draft/draft";
import { personInWords } from "../draft/person";
import { shownPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { entries, fits, forget, remember, seen, thumbnailOf } from "../history/store";
import { faultsOf } from "../measure/faults";
import { PictureProblem } from "../measure/PictureProblem";
import { wordFor } from "../messages/words";
import { messages } from "../messages";
import { changeAgain } from "../result/again";
import { ResultView } from "../result/ResultView";
import { beginning, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { Progress } from "./Progress";
import { isActive, trouble, watch } from "./watch";

export function FitView({ which }: { which: FitRef }) {
  const pictures = useSignal<readonly Picture[]>([]);
  const { id } = which;
  const fit = fits.value[id];
  const fail = (error: unknown) => (trouble.value = problemFrom(error));

  useEffect(() => {
    trouble.value = null;
    const leaving = new AbortController();
    watch(which, leaving.signal).catch(fail);
    return () => {
      leaving.abort();
      trouble.value = null;
    };
  }, [id]);

  const isKnown = fit !== undefined;
  useEffect(() => {
    if (!fit) return undefined;
    const leaving = new AbortController();
    let shown: readonly Picture[] = [];
    const drop = () => shown.forEach(({ url }) => URL.revokeObjectURL(url));
    untilReached(() => openedPictures(fit), leaving.signal)
      .then((opened) => {
        shown = opened;
        if (leaving.signal.aborted) return drop();
        pictures.value = opened;
        const { name, element } = opened[0]!;
        // Opened by its link: from now on this browser knows it as well.
        remember({ kind: fit.kind, id, name, startedAt: fit.created_at, thumbnail: thumbnailOf(element) });
      })
      .catch((error) => leaving.signal.aborted || fail(error));
    return () => {
      leaving.abort();
      drop();
    };
  }, [id, isKnown]);

  if (trouble.value) return <Trouble which={which} problem={trouble.value} />;
  if (!fit) return <main class="waiting" aria-busy="true" />;
  if (fit.state === "succeeded") return <ResultView fit={fit} pictures={pictures.value} />;
  if (isActive(fit)) {
    const cancel = async () => {
      try {
        seen(await cancelFit(fit));
        return true;
      } catch (error) {
        if (!isUnreachable(error)) fail(error);
        return false;
      }
    };
    return <Progress fit={fit} pictures={pictures.value} cancel={cancel} />;
  }
  return <Ended fit={fit} pictures={pictures.value} />;
}

async function openedPictures(fit: Fit): Promise<readonly Picture[]> {
  const [name, ...files] = await Promise.all([nameOf(fit), ...fit.pictures.map(({ image }) => getPicture(image))]);
  return Promise.all(files.map((file) => shownPicture(file, name)));
}

/** As this browser knows it; a fit opened by its link is named by whom it shows. */
async function nameOf(fit: Fit): Promise<string> {
  const known = entries.value.find((entry) => entry.id === fit.id);
  return known?.name ?? personInWords(await getAsked(fit), person.value.units);
}

function Trouble({ which, problem }: { which: FitRef; problem: Problem }) {
  const { fit: words, frame } = messages;
  const { kind, id } = which;
  const gone = problem.status === 404 || problem.status === 410;
  return (
    <main class="ended">
      <h1>{gone ? words.of[kind].gone : words.of[kind].notShown}</h1>
      <ProblemNote problem={problem} />
      <div class="row">
        <button class="button is-primary" type="button" onClick={() => go(beginning(kind))}>
          {words.of[kind].another}
        </button>
        {gone ? (
          <button
            class="button"
            type="button"
            onClick={() => {
              forget(id);
              go(beginning(kind));
            }}
          >
            {words.forget}
          </button>
        ) : (
          <button class="button" type="button" onClick={() => location.reload()}>
            {frame.tryAgain}
          </button>
        )}
      </div>
    </main>
  );
}

function Ended({ fit, pictures }: { fit: Fit; pictures: readonly Picture[] }) {
  const { of, picture: pictureWords } = messages.fit;
  const words = of[fit.kind];
  const fault = useSignal<Problem | null>(null);
  const { views, rest } = fit.problem ? faultsOf(fit.problem) : { views: new Map<number, Problem>(), rest: null };
  const change = () => changeAgain(fit, pictures).catch((error) => (fault.value = problemFrom(error)));
  return (
    <main class="ended">
      <h1>{wordFor(words.endings, fit.state)}</h1>
      {rest && <ProblemNote problem={rest} />}
      <ul class="ended-pictures">
        {pictures.map(({ url }, number) => (
          <li key={url}>
            <img class="ended-picture" src={url} alt={pictureWords(number + 1)} />
            {views.has(number) && <PictureProblem problem={views.get(number)!} />}
          </li>
        ))}
      </ul>
      {fault.value && <ProblemNote problem={fault.value} />}
      <div class="row">
        {pictures.length > 0 && (
          <button class="button is-primary" type="button" onClick={() => void change()}>
            {words.change}
          </button>
        )}
        <button class="button" type="button" onClick={() => go(beginning(fit.kind))}>
          {words.another}
        </button>
      </div>
    </main>
  );
}
