// The frame of the page: its head, and what the address asks for.
import { useSignal } from "@preact/signals";
import { entries, jobs } from "./history/store";
import { HistoryPanel } from "./history/HistoryPanel";
import { FitView } from "./fit/FitView";
import { isActive } from "./fit/watch";
import { Workbench } from "./panel/Workbench";
import { MeasureView } from "./measure/MeasureView";
import { ScanView } from "./measure/ScanView";
import { scans } from "./measure/watch";
import { MEASURE_ADDRESS, isMeasuring, openFit, openScan } from "./route";
import { announcement } from "./ui/announce";
import { Icon } from "./ui/Icon";
import { IconButton } from "./ui/IconButton";
import { KeyDialog } from "./ui/KeyDialog";
import { theme, toggleTheme } from "./ui/theme";

export function App() {
  const showsHistory = useSignal(false);
  const id = openFit.value;
  const scan = openScan.value;
  const active = [...Object.values(jobs.value), ...Object.values(scans.value)].filter(isActive).length;
  return (
    <>
      <header class="head">
        <a class="brand" href="#/" aria-label="Maquette: start">
          <svg width="22" height="22" viewBox="0 0 32 32" aria-hidden="true">
            <circle cx="16" cy="7" r="4.2" />
            <path d="M7 13.5h18M16 13.5V22M16 21l-5.5 8M16 21l5.5 8" />
          </svg>
          Maquette
        </a>
        <nav>
          {id && (
            <a class="head-link" href="#/">
              <Icon name="plus" />
              New
            </a>
          )}
          <a class="head-link" href={MEASURE_ADDRESS} aria-current={isMeasuring.value ? "page" : undefined}>
            <Icon name="body" />
            Measure
          </a>
          <button class="head-link" type="button" onClick={() => (showsHistory.value = true)}>
            <Icon name="list" />
            Fits
            {entries.value.length > 0 && <span class={`badge ${active > 0 ? "is-active" : ""}`}>{entries.value.length}</span>}
          </button>
          <a class="head-link is-wide-only" href="/docs">
            API
          </a>
          <IconButton icon="theme" label={theme.value === "dark" ? "Light page" : "Dark page"} onClick={toggleTheme} />
        </nav>
      </header>
      <Screen fit={id} scan={scan} />
      {showsHistory.value && <HistoryPanel onClose={() => (showsHistory.value = false)} />}
      <KeyDialog />
      <p class="unseen" role="status" aria-live="polite">
        {announcement.value}
      </p>
    </>
  );
}

function Screen({ fit, scan }: { fit: string | null; scan: string | null }) {
  if (fit) return <FitView key={fit} id={fit} />;
  if (scan) return <ScanView key={scan} id={scan} />;
  return isMeasuring.value ? <MeasureView /> : <Workbench />;
}
