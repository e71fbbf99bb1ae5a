// The site's token in place of a key: in memory only, and another when it has expired.
import { batch, effect, signal } from "@preact/signals";
import { accepted, apiKey, keyQuestion, present } from "../api/key";
import { PLACES, PLACE_NAMES } from "../measure/places";
import { measure } from "../measure/send";
import { MEASURE_ADDRESS, go } from "../route";
import { isUnderWay } from "./outcome";
import { tell } from "./parent";

/** A scan is being asked for anew. */
export const isRepeating = signal(false);

let asked = false;
let answers = false;

export function startAsking(): void {
  effect(() => {
    if (keyQuestion.value === null) return;
    // Else a site whose tokens are never accepted would be asked again and again, as fast as it answers.
    if (answers && accepted.peek() !== apiKey.peek()) {
      tell({ type: "maquette:refused", field: "token", reason: "The service refused this token as well: see that it was made with a key of this service." });
      return;
    }
    asked = true;
    tell({ type: "maquette:token-needed" });
  });
}

export function takeToken(token: string): void {
  const renews = apiKey.value !== null && apiKey.value !== token;
  const repeats = renews && isUnderWay();
  answers = asked;
  asked = false;
  batch(() => {
    if (repeats) go(MEASURE_ADDRESS);
    present(token);
    if (renews) sendAnew();
  });
  if (repeats) void repeat();
}

/** A token sees what was made with it alone: what was uploaded with another is not there for it. */
function sendAnew(): void {
  for (const { picture, uploaded, check, problem } of PLACE_NAMES.map((name) => PLACES[name])) {
    if (!picture.value) continue;
    uploaded.value = null;
    check.value = null;
    problem.value = null;
    picture.value = { ...picture.value };
  }
}

async function repeat(): Promise<void> {
  isRepeating.value = true;
  await measure();
  isRepeating.value = false;
}
