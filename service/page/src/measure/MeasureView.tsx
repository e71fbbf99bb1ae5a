// The pictures of a scan and its person, and the one button: Measure.
import { useSignal } from "@preact/signals";
import { canPropose } from "../draft/proposing";
import { loadPerson } from "../draft/request";
import { openFile } from "../panel/open";
import { PersonPanel } from "../panel/PersonPanel";
import { ProblemNote } from "../ui/ProblemNote";
import { measureTodo, PLACES, PLACE_NAMES, putPicture } from "./places";
import { PlaceCard } from "./PlaceCard";
import { measure, scanProblem } from "./send";

const WORDS = {
  noHeight: "The height is needed: pictures alone do not tell how large a body is.",
  weight: "If you know it, the weight makes measurements better.",
};

export function MeasureView() {
  const isEmpty = PLACE_NAMES.every((name) => PLACES[name].picture.value === null);
  return (
    <main class="measure">
      <div class="measure-head">
        <h1>Measure a person</h1>
        <p class="lead">Two pictures, from the front and from the side, and a height.</p>
      </div>
      <div class="measure-person">
        <PersonPanel words={WORDS} />
      </div>
      {!canPropose.value && <NoDetector />}
      <div class="places">
        {PLACE_NAMES.map((name) => (
          <PlaceCard key={name} place={PLACES[name]} />
        ))}
      </div>
      {isEmpty && (
        <p class="fine">
          No pictures at hand?
          <button class="link" type="button" onClick={() => void trySamplePair()}>
            Try the sample pair
          </button>
        </p>
      )}
      <Rules />
      <MeasureBar />
    </main>
  );
}

function Rules() {
  return (
    <details class="measure-rules">
      <summary>For good measurements</summary>
      <ul>
        <li>Tight clothes or underwear, hair tied up, no shoes.</li>
        <li>The phone upright at the height of the belly, level, two to three metres away; stood on something or held by somebody.</li>
        <li>From head to feet in the picture, with some room around.</li>
        <li>Light from the camera's side, and a wall of another colour than skin and clothes.</li>
        <li>Breathe out, stand relaxed, do not draw in the belly. Both pictures from the same place: turn yourself, not the camera.</li>
        <li>Pictures of the phone's own camera, chosen as files, name their lens: then nothing has to be assumed.</li>
      </ul>
    </details>
  );
}

/** Without proposals somebody has to click points, which is done picture by picture. */
function NoDetector() {
  const front = PLACES.front.picture.value;
  return (
    <div class="note is-problem" role="alert">
      <strong>This service cannot find the person by itself</strong>
      <p>
        Its detector is not installed, so pictures are neither checked nor measured without clicks. Click the joints in the editor, which
        measures by one picture.
      </p>
      <div class="row">
        {front ? (
          <button class="button is-small" type="button" onClick={() => void openFile(front.file, front.name, "open")}>
            Open the front picture there
          </button>
        ) : (
          <a class="button is-small" href="#/">
            To the editor
          </a>
        )}
      </div>
    </div>
  );
}

function MeasureBar() {
  const sending = useSignal(false);
  const asks = useSignal(false);
  const blocked = PLACE_NAMES.filter((name) => PLACES[name].check.value?.usable === false);
  const todo = measureTodo.value ?? (canPropose.value ? null : "Points cannot be proposed here");
  const send = async () => {
    asks.value = false;
    sending.value = true;
    await measure();
    sending.value = false;
  };
  if (asks.value && blocked.length > 0) {
    return (
      <div class="submit" role="group" aria-label="Measure all the same?">
        <p>{`The ${blocked.join(" and the ")} picture should be taken again. Measure all the same?`}</p>
        <div class="submit-row">
          <button class="button grow" type="button" onClick={() => (asks.value = false)}>
            Back
          </button>
          <button class="button grow" type="button" onClick={() => void send()}>
            Measure anyway
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
        {sending.value ? "Sending …" : (todo ?? "Measure")}
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
