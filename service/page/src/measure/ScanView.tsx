// One scan: on its way, ended without a result, or its result.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { cancelScan, getPicture } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem, Scan } from "../api/types";
import { shownPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { isActive } from "../fit/watch";
import { forget } from "../history/store";
import { wordFor } from "../messages/catalogue";
import { messages } from "../messages/language";
import { MEASURE_ADDRESS, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { faultsOf } from "./faults";
import { PictureProblem } from "./PictureProblem";
import { ScanProgress } from "./ScanProgress";
import { ScanResultView } from "./ScanResultView";
import { rememberScan, reopen } from "./send";
import { scanTrouble, scans, seenScan, watchScan } from "./watch";

export function ScanView({ id }: { id: string }) {
  const problem = useSignal<Problem | null>(null);
  const pictures = useSignal<readonly Picture[]>([]);
  const scan = scans.value[id];
  const fail = (error: unknown) => (problem.value = scanTrouble.value = problemFrom(error));

  useEffect(() => {
    scanTrouble.value = null;
    const leaving = new AbortController();
    watchScan(id, leaving.signal).catch(fail);
    return () => leaving.abort();
  }, [id]);

  const isKnown = scan !== undefined;
  useEffect(() => {
    if (!scan) return undefined;
    let gone = false;
    let shown: readonly Picture[] = [];
    const drop = () => shown.forEach(({ url }) => URL.revokeObjectURL(url));
    Promise.all(scan.links.views.map(async ({ image }, number) => shownPicture(await getPicture(image), messages.peek().measure.progress.picture(number + 1))))
      .then((opened) => {
        shown = opened;
        if (gone) return drop();
        pictures.value = opened;
        return rememberScan(scan, opened[0]!.element);
      })
      .catch(fail);
    return () => {
      gone = true;
      drop();
    };
  }, [id, isKnown]);

  if (problem.value) return <Trouble id={id} problem={problem.value} />;
  if (!scan) return <main class="waiting" aria-busy="true" />;
  if (scan.state === "succeeded") return <ScanResultView scan={scan} pictures={pictures.value} />;
  if (isActive(scan)) {
    const cancel = () => cancelScan(id).then(seenScan, fail);
    return <ScanProgress scan={scan} pictures={pictures.value} onCancel={() => void cancel()} />;
  }
  return <Ended scan={scan} pictures={pictures.value} />;
}

function Trouble({ id, problem }: { id: string; problem: Problem }) {
  const { ended: words } = messages.value.measure;
  const gone = problem.status === 404 || problem.status === 410;
  return (
    <main class="ended">
      <h1>{gone ? words.gone : words.notShown}</h1>
      <ProblemNote problem={problem} />
      <div class="row">
        <button
          class="button is-primary"
          type="button"
          onClick={() => {
            if (gone) forget(id);
            go(MEASURE_ADDRESS);
          }}
        >
          {words.somebody}
        </button>
      </div>
    </main>
  );
}

function Ended({ scan, pictures }: { scan: Scan; pictures: readonly Picture[] }) {
  const { ended: words } = messages.value.measure;
  const trouble = useSignal<Problem | null>(null);
  const { views, rest } = scan.problem ? faultsOf(scan.problem) : { views: new Map<number, Problem>(), rest: null };
  const again = () => reopen(scan, scan.problem ?? null).catch((error) => (trouble.value = problemFrom(error)));
  return (
    <main class="ended">
      <h1>{wordFor(words.states, scan.state)}</h1>
      {rest && <ProblemNote problem={rest} />}
      <ul class="ended-pictures">
        {pictures.map(({ url }, number) => (
          <li key={url}>
            <img class="ended-picture" src={url} alt={words.picture(number + 1)} />
            {views.has(number) && <PictureProblem problem={views.get(number)!} />}
          </li>
        ))}
      </ul>
      {trouble.value && <ProblemNote problem={trouble.value} />}
      <div class="row">
        <button class="button is-primary" type="button" onClick={() => void again()}>
          {words.change}
        </button>
      </div>
    </main>
  );
}
