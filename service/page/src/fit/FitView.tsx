// One fit: on its way, ended without a result, or its result.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { cancelFit, getAsked, getPicture } from "../api/calls";
import { isUnreachable, problemFrom, untilReached } from "../api/client";
import type { Fit, Problem } from "../api/types";
import { person } from "../draft/draft";
import { openAgain } from "../draft/open";
import { personInWords } from "../draft/person";
import { shownPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { entries, fits, forget, remember, seen, thumbnailOf } from "../history/store";
import { wordFor } from "../messages/words";
import { messages } from "../messages";
import { ResultView } from "../result/ResultView";
import { START_ADDRESS, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { Progress } from "./Progress";
import { isActive, trouble, watch } from "./watch";

export function FitView({ id }: { id: string }) {
  const pictures = useSignal<readonly Picture[]>([]);
  const fit = fits.value[id];
  const fail = (error: unknown) => (trouble.value = problemFrom(error));

  useEffect(() => {
    trouble.value = null;
    const leaving = new AbortController();
    watch(id, leaving.signal).catch(fail);
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
        remember({ id, name, startedAt: fit.created_at, thumbnail: thumbnailOf(element) });
      })
      .catch((error) => leaving.signal.aborted || fail(error));
    return () => {
      leaving.abort();
      drop();
    };
  }, [id, isKnown]);

  if (trouble.value) return <Trouble id={id} problem={trouble.value} />;
  if (!fit) return <main class="waiting" aria-busy="true" />;
  if (fit.state === "succeeded") return <ResultView fit={fit} pictures={pictures.value} />;
  if (isActive(fit)) {
    const cancel = async () => {
      try {
        seen(await cancelFit(id));
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
  const asked = await getAsked(fit.id);
  // As this browser knows it; a fit opened by its link is named by whom it shows.
  const name = entries.value.find(({ id }) => id === fit.id)?.name ?? personInWords(asked, person.value.units);
  const count = asked.views?.length ?? 1;
  const paths = Array.from({ length: count }, (_, number) => fit.links.files[`views/${number}/image`]!);
  return Promise.all(paths.map(async (path) => shownPicture(await getPicture(path), name)));
}

function Trouble({ id, problem }: { id: string; problem: Problem }) {
  const { fit: words, frame } = messages;
  const gone = problem.status === 404;
  return (
    <main class="ended">
      <h1>{gone ? words.gone : words.notShown}</h1>
      <ProblemNote problem={problem} />
      <div class="row">
        <button class="button is-primary" type="button" onClick={() => go(START_ADDRESS)}>
          {words.another}
        </button>
        {gone ? (
          <button
            class="button"
            type="button"
            onClick={() => {
              forget(id);
              go(START_ADDRESS);
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
  const words = messages.fit;
  const fault = useSignal<Problem | null>(null);
  const change = () => openAgain(fit, 0, pictures).catch((error) => (fault.value = problemFrom(error)));
  return (
    <main class="ended">
      <h1>{wordFor(words.endings, fit.state)}</h1>
      {fit.problem && <ProblemNote problem={fit.problem} />}
      <ul class="fit-pictures">
        {pictures.map(({ url }, number) => (
          <li key={url}>
            <img src={url} alt={words.picture(number + 1)} />
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
        <button class="button" type="button" onClick={() => go(START_ADDRESS)}>
          {words.another}
        </button>
      </div>
    </main>
  );
}
