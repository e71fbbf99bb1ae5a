// The frame of the page: its head, and what the address asks for.
import { useSignal } from "@preact/signals";
import { entries, fits } from "./history/store";
import { FitView } from "./fit/FitView";
import { isActive } from "./fit/watch";
import { Start } from "./start/Start";
import { START_ADDRESS, TRY_ADDRESS, isOnAccuracy, isPreparing, isTrying, openFit } from "./route";
import { messages } from "./messages";
import { isFull } from "./stage/full";
import { announcement } from "./ui/announce";
import { Icon } from "./ui/Icon";
import { IconButton } from "./ui/IconButton";
import { KeyDialog } from "./ui/KeyDialog";
import { later } from "./ui/later";
import { theme, toggleTheme } from "./ui/theme";

const AccuracyView = later(() => import("./accuracy/AccuracyView").then((loaded) => loaded.AccuracyView));
const HistoryPanel = later(() => import("./history/HistoryPanel").then((loaded) => loaded.HistoryPanel), null);
const TryView = later(() => import("./try/TryView").then((loaded) => loaded.TryView));
const Workbench = later(() => import("./panel/Workbench").then((loaded) => loaded.Workbench));

export function App() {
  const { frame } = messages;
  const showsHistory = useSignal(false);
  const fit = openFit.value;
  const active = Object.values(fits.value).filter(isActive).length;
  return (
    <>
      <header class="head" inert={isFull.value}>
        <a class="brand" href={START_ADDRESS} aria-label={frame.start}>
          <svg width="22" height="22" viewBox="0 0 32 32" aria-hidden="true">
            <circle cx="16" cy="7" r="4.2" />
            <path d="M7 13.5h18M16 13.5V22M16 21l-5.5 8M16 21l5.5 8" />
          </svg>
          <span class="brand-name">Maquette</span>
        </a>
        <nav>
          {(fit || isPreparing.value) && (
            <a class="head-link" href={START_ADDRESS}>
              <Icon name="plus" />
              {frame.fresh}
            </a>
          )}
          <button class="head-link" type="button" onClick={() => (showsHistory.value = true)}>
            <Icon name="list" />
            {frame.history}
            {entries.value.length > 0 && <span class={`badge ${active > 0 ? "is-active" : ""}`}>{entries.value.length}</span>}
          </button>
          <a class="head-link is-wide-only" href={TRY_ADDRESS}>
            {messages.trying.title}
          </a>
          <a class="head-link is-wide-only" href="/documentation/">
            {frame.documentation}
          </a>
          <IconButton icon="theme" label={theme.value === "dark" ? frame.lightPage : frame.darkPage} onClick={toggleTheme} />
        </nav>
      </header>
      <Screen />
      {showsHistory.value && <HistoryPanel onClose={() => (showsHistory.value = false)} />}
      <KeyDialog />
      <p class="unseen" role="status" aria-live="polite">
        {announcement.value}
      </p>
    </>
  );
}

function Screen() {
  const fit = openFit.value;
  if (fit) return <FitView key={fit} id={fit} />;
  if (isOnAccuracy.value) return <AccuracyView />;
  if (isTrying.value) return <TryView />;
  return isPreparing.value ? <Workbench /> : <Start />;
}
