// A fit on its way: how far it is, and at which picture.
import { useEffect, useState } from "preact/hooks";
import { isCutOff } from "../api/connection";
import type { Fit } from "../api/types";
import type { Picture } from "../draft/picture";
import { percent } from "../messages/figures";
import { messages } from "../messages";

interface Props {
  readonly fit: Fit;
  readonly pictures: readonly Picture[];
  /** Whether the service was told. */
  readonly cancel: () => Promise<boolean>;
}

export function Progress({ fit, pictures, cancel }: Props) {
  const { fit: words } = messages;
  const [stopping, setStopping] = useState(fit.cancel_requested);
  // The button that was pressed lay far down on a phone.
  useEffect(() => scrollTo(0, 0), []);
  return (
    <main class="running">
      <progress class="bar" max={1} value={fit.progress} aria-label={words.progress}>
        {percent(fit.progress)}
      </progress>
      <h1 class="running-line">{fit.state === "queued" ? words.queued : words.running(percent(fit.progress))}</h1>
      {isCutOff.value && (
        <p class="note" role="status">
          {words.cutOff}
        </p>
      )}
      <ul class="fit-pictures">
        {pictures.map(({ url }, number) => (
          <li key={url} class={fit.view === number ? "is-current" : ""}>
            <img src={url} alt={pictures.length > 1 ? words.picture(number + 1) : words.onlyPicture} />
          </li>
        ))}
      </ul>
      <button
        class="button"
        type="button"
        disabled={stopping}
        onClick={() => {
          setStopping(true);
          void cancel().then(setStopping);
        }}
      >
        {stopping ? words.stopping : words.cancel}
      </button>
    </main>
  );
}
