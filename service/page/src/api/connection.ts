// Whether the service is reached, as far as is known: the browser says when it is offline, and requests say the rest.
import { computed, signal } from "@preact/signals";

export const UNREACHABLE = "unreachable";

export const isOffline = signal(false);
/** How the last request ended that was not given up. */
export const isReached = signal(true);
export const isCutOff = computed(() => isOffline.value || !isReached.value);

const FIRST_PAUSE_MS = 2000;
const LONGEST_PAUSE_MS = 30_000;

export function startWatchingConnection(): void {
  const look = () => (isOffline.value = !navigator.onLine);
  look();
  addEventListener("online", look);
  addEventListener("offline", look);
}

/** How long to wait before the attempt after so many. */
export function pauseMs(attempts: number): number {
  return Math.min(FIRST_PAUSE_MS * 2 ** attempts, LONGEST_PAUSE_MS);
}

/** Until that time is over, the browser is online again, or it is given up. */
export function pause(ms: number, leaving: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const done = () => {
      clearTimeout(timer);
      removeEventListener("online", done);
      resolve();
    };
    const timer = setTimeout(done, ms);
    addEventListener("online", done);
    leaving.addEventListener("abort", done);
  });
}
