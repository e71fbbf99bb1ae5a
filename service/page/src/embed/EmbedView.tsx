// What a frame shows: the Measure screen and its fit, without the page's head.
import type { FitRef } from "../api/fits";
import { FitView } from "../fit/FitView";
import { MeasureView } from "../measure/MeasureView";
import { messages } from "../messages/language";
import { openFit } from "../route";
import { announcement } from "../ui/announce";
import { SandboxNote } from "../ui/SandboxNote";
import { isFramed } from "./parent";
import { isStarted } from "./started";
import { isRepeating } from "./token";

export function EmbedView() {
  return (
    <>
      <SandboxNote />
      <Screen fit={openFit.value} />
      <p class="unseen" role="status" aria-live="polite">
        {announcement.value}
      </p>
    </>
  );
}

function Screen({ fit }: { fit: FitRef | null }) {
  const { embed } = messages.value;
  if (!isStarted.value) {
    return (
      <main class="waiting" aria-busy={isFramed}>
        <p class="fine">{isFramed ? embed.waiting : embed.alone}</p>
      </main>
    );
  }
  if (isRepeating.value) return <main class="waiting" aria-busy="true" />;
  return fit ? <FitView key={fit.id} which={fit} /> : <MeasureView />;
}
