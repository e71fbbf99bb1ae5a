// Where a fit is prepared: the picture, who is in it, one button; all else is behind "Correct something".
import { useEffect } from "preact/hooks";
import { isAsleep, isCorrecting, picture, points, upcoming } from "../draft/draft";
import { isRestoring } from "../draft/lasting";
import { liveProblem } from "../draft/live";
import { isProposing } from "../draft/proposing";
import { isEditing } from "../mask/edits";
import { messages } from "../messages";
import { isEnough } from "../points/placed";
import { hasProposed } from "../points/proposed";
import { isFull } from "../stage/full";
import { Stage } from "../stage/Stage";
import { ProblemNote } from "../ui/ProblemNote";
import { later } from "../ui/later";
import { isNarrow } from "../ui/narrow";
import { openFile, openProblem } from "./open";
import { PersonPanel } from "./PersonPanel";
import { Start } from "./Start";
import { SubmitBar } from "./SubmitBar";

const Corrections = later(() => import("./Corrections").then((loaded) => loaded.Corrections), null);
const NextLine = later(() => import("./PointsPanel").then((loaded) => loaded.NextLine), null);
const MaskStage = later(() => import("../mask/MaskStage").then((loaded) => loaded.MaskStage), null);

export function Workbench() {
  const { panel } = messages;
  const shown = picture.value;
  // Nobody proposes them: they are clicked.
  const hasToClick = shown !== null && !isProposing.value && !isEnough(points.value);
  useEffect(() => {
    if (shown) isAsleep.value = false;
  }, [shown]);
  useEffect(() => {
    if (hasToClick) isCorrecting.value = true;
  }, [hasToClick]);
  useEffect(() => () => void (isFull.value = false), []);
  if (!shown) return isRestoring.value ? <main class="waiting" aria-busy="true" /> : <Start />;
  const corrects = isCorrecting.value;
  const look = ["bench-stage", upcoming.value ? "" : "is-settled", hasProposed(points.value) ? "is-proposed" : "", isFull.value ? "is-full" : "", corrects ? "" : "is-plain"];
  return (
    <main
      class="bench"
      onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => {
        event.preventDefault();
        const file = event.dataTransfer?.files[0];
        if (file) void openFile(file);
      }}
    >
      <h1 class="unseen">{panel.title}</h1>
      {isNarrow.value && (
        <div class="bench-person" inert={isFull.value}>
          <PersonPanel />
        </div>
      )}
      <div class={look.join(" ")}>
        {isEditing.value ? (
          <MaskStage />
        ) : (
          <>
            {corrects && <NextLine />}
            <Stage />
          </>
        )}
      </div>
      <div class="panel" inert={isFull.value}>
        <div class="panel-scroll">
          {openProblem.value && (
            <div class="section is-tight">
              <p class="note is-problem" role="alert">
                {openProblem.value}
              </p>
            </div>
          )}
          {!isNarrow.value && <PersonPanel />}
          {liveProblem.value && (
            <div class="section is-tight">
              <ProblemNote problem={liveProblem.value} />
            </div>
          )}
          <details class="corrections" open={corrects} onToggle={({ currentTarget }) => (isCorrecting.value = currentTarget.open)}>
            <summary>
              <h2>{panel.correct}</h2> <span class="count">{panel.correctWhat}</span>
            </summary>
            {corrects && <Corrections />}
          </details>
        </div>
        <SubmitBar />
      </div>
    </main>
  );
}
