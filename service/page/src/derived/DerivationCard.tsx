// One thing made of a fit: where it stands, what there is to know of it, the way to the stage, its files.
import type { Derivation, DerivationRequest } from "../api/types";
import { isActive } from "../fit/watch";
import { messages } from "../messages";
import { FileButton } from "../result/FileButton";
import { tableOf, usePictureOf } from "../result/files";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { DerivationWarnings } from "./DerivationSummary";
import { useDerivationResult } from "./derivationResult";
import { kindLabel, kindOf, wordInSentence } from "./kinds";
import { viewsOf } from "./views";

const REFUSED = 422;

interface Props {
  readonly made: Derivation;
  readonly isOnStage: boolean;
  readonly onShow: () => void;
  readonly onRetry: () => void;
  readonly onMake: (asked: DerivationRequest) => void;
  readonly onErase: () => void;
}

export function DerivationCard({ made, isOnStage, onShow, onRetry, onMake, onErase }: Props) {
  const { derived, frame } = messages;
  const inSentence = wordInSentence(made.kind);
  const done = made.state === "succeeded";
  const kind = kindOf(made.kind);
  const result = useDerivationResult(made);
  const files = Object.entries(made.links.artifacts ?? {}).filter(([name]) => name !== "result.json");
  if (done && kind?.hasTable) files.push(tableOf(made));
  const largest = made.problem?.errors?.[0]?.largest ?? null;
  const smaller = largest === null ? null : (kind?.smaller?.(largest) ?? null);
  // What was refused would be refused again.
  const isRefused = made.problem?.status === REFUSED;
  return (
    <li class={isOnStage ? "is-on-stage" : ""}>
      <header class="section-head">
        <h3>{kindLabel(made.kind)}</h3>
        <IconButton icon="trash" label={derived.remove(inSentence)} onClick={onErase} />
      </header>
      {isActive(made) && <progress class="bar" max={1} value={made.progress} aria-label={derived.progress(inSentence)} />}
      {result && <DerivationWarnings of={result} />}
      {smaller ? (
        <>
          <p class="note is-problem" role="alert">
            {smaller.refusal}
          </p>
          <button class="button is-small" type="button" onClick={() => onMake(smaller.request)}>
            {smaller.make}
          </button>
        </>
      ) : (
        made.problem && <ProblemNote problem={made.problem} />
      )}
      {made.links.retry && !done && !isRefused && (
        <button class="button is-small" type="button" onClick={onRetry}>
          {frame.tryAgain}
        </button>
      )}
      {done && viewsOf(made).length > 0 && <ToStage made={made} isOnStage={isOnStage} onShow={onShow} />}
      {result && kind?.told?.(result)}
      {files.length > 0 && (
        <ul class="downloads">
          {files.map(([name, path]) => (
            <li key={name}>
              <FileButton name={name} path={path} />
            </li>
          ))}
        </ul>
      )}
    </li>
  );
}

/** Its first picture, small, which leads to the stage. */
function ToStage({ made, isOnStage, onShow }: Pick<Props, "made" | "isOnStage" | "onShow">) {
  const { derived } = messages;
  const small = viewsOf(made).find(({ picture }) => picture)?.picture;
  const url = usePictureOf(made, small?.still ?? small?.file ?? "", small !== undefined);
  return (
    <button class="to-stage" type="button" aria-pressed={isOnStage} aria-label={derived.show(wordInSentence(made.kind))} onClick={onShow}>
      <span class="to-stage-picture">{url && <img src={url} alt="" />}</span>
      <b>{derived.showLarge}</b>
    </button>
  );
}
