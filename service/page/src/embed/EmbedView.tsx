// What a frame shows: the Measure screen and its scan, without the page's head.
import { MeasureView } from "../measure/MeasureView";
import { ScanView } from "../measure/ScanView";
import { messages } from "../messages/language";
import { openScan } from "../route";
import { announcement } from "../ui/announce";
import { SandboxNote } from "../ui/SandboxNote";
import { isFramed } from "./parent";
import { isStarted } from "./started";
import { isRepeating } from "./token";

export function EmbedView() {
  return (
    <>
      <SandboxNote />
      <Screen scan={openScan.value} />
      <p class="unseen" role="status" aria-live="polite">
        {announcement.value}
      </p>
    </>
  );
}

function Screen({ scan }: { scan: string | null }) {
  const { embed } = messages.value;
  if (!isStarted.value) {
    return (
      <main class="waiting" aria-busy={isFramed}>
        <p class="fine">{isFramed ? embed.waiting : embed.alone}</p>
      </main>
    );
  }
  if (isRepeating.value) return <main class="waiting" aria-busy="true" />;
  return scan ? <ScanView key={scan} id={scan} /> : <MeasureView />;
}
