// The pictures of a scan and its person, and the one button: Measure.
import { useSignal } from "@preact/signals";
import { canPropose } from "../draft/proposing";
import { loadPerson } from "../draft/request";
import { messages } from "../messages";
import { openFile } from "../panel/open";
import { PersonPanel } from "../panel/PersonPanel";
import { START_ADDRESS } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { HowTo } from "./HowTo";
import { measureTodo, PLACES, PLACE_NAMES, putPicture } from "./places";
import { PlaceCard } from "./PlaceCard";
import { leftOut, measure, scanProblem } from "./send";
import { pictureOf } from "./views";

export function MeasureView() {
  const { measure: words } = messages;
  const isEmpty = PLACE_NAMES.every((name) => PLACES[name].picture.value === null);
  return (
    <main class="measure">
      <div class="measure-head">
        <h1>{words.title}</h1>
        <p class="lead">{words.lead}</p>
      </div>
      <div class="measure-parts">
        <div class="measure-person">
          <PersonPanel words={words} />
        </div>
        <div class="measure-pictures">
          {!canPropose.value && <NoDetector />}
          <Rules />
          <HowTo />
          {leftOut.value > 0 && <p class="note">{words.leftOut(leftOut.value)}</p>}
          <div class="places">
            {PLACE_NAMES.map((name) => (
              <PlaceCard key={name} place={PLACES[name]} />
            ))}
          </div>
          {isEmpty && (
            <p class="fine">
              {words.noPictures}{" "}
              <button class="link" type="button" onClick={() => void trySamplePair()}>
                {words.trySample}
              </button>
            </p>
          )}
        </div>
      </div>
      <MeasureBar />
    </main>
  );
}

function Rules() {
  const { rules } = messages.measure;
  return (
    <details class="measure-rules">
      <summary>{rules.title}</summary>
      <ul>
        {rules.list.map((rule) => (
          <li key={rule}>{rule}</li>
        ))}
      </ul>
    </details>
  );
}

/** Without proposals somebody has to click points, which is done picture by picture. */
function NoDetector() {
  const { noDetector: words } = messages.measure;
  const front = PLACES.front.picture.value;
  return (
    <div class="note is-problem" role="alert">
      <strong>{words.title}</strong>
      <p>{words.why}</p>
      <div class="row">
        {front ? (
          <button class="button is-small" type="button" onClick={() => void openFile(front.file, front.name, "open")}>
            {words.openFront}
          </button>
        ) : (
          <a class="button is-small" href={START_ADDRESS}>
            {words.toEditor}
          </a>
        )}
      </div>
    </div>
  );
}

function MeasureBar() {
  const { frame, measure: words, result } = messages;
  const sending = useSignal(false);
  const asks = useSignal(false);
  const blocked = PLACE_NAMES.filter((name) => PLACES[name].check.value?.usable === false);
  const todo = measureTodo.value ?? (canPropose.value ? null : words.todo.noDetector);
  const send = async () => {
    asks.value = false;
    sending.value = true;
    await measure();
    sending.value = false;
  };
  if (asks.value && blocked.length > 0) {
    return (
      <div class="submit" role="group" aria-label={words.anyway.title}>
        <p>{words.anyway.ask(blocked.map(pictureOf))}</p>
        <div class="submit-row">
          <button class="button grow" type="button" onClick={() => (asks.value = false)}>
            {words.anyway.back}
          </button>
          <button class="button grow" type="button" onClick={() => void send()}>
            {result.measureAnyway}
          </button>
        </div>
      </div>
    );
  }
  return (
    <div class="submit">
      {scanProblem.value && <ProblemNote problem={scanProblem.value} />}
      <button
        class="button is-primary is-wide"
        type="button"
        disabled={todo !== null || sending.value}
        onClick={() => (blocked.length > 0 ? (asks.value = true) : void send())}
      >
        {sending.value ? frame.sending : (todo ?? words.submit)}
      </button>
    </div>
  );
}

async function trySamplePair(): Promise<void> {
  loadPerson({ gender: "female", height_m: 1.555 });
  for (const name of PLACE_NAMES) {
    const file = await (await fetch(`/page/scan_${name}.jpg`)).blob();
    await putPicture(PLACES[name], file, `scan_${name}.jpg`);
  }
}
