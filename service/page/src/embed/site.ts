// embed.js, which runs in the site: a frame with the page in it, and what came out of it as a promise.

/** The page says that it is there as soon as it is loaded; a frame that may not show it never does. */
const READY_WITHIN_MS = 10_000;

const page = new URL("/#/embed", (document.currentScript as HTMLScriptElement).src);

function failure(message: string, more: Partial<Maquette.Failure> = {}): Maquette.Failure {
  return Object.assign(new Error(message), { name: "MaquetteError" as const }, more);
}

function measure(element: HTMLElement, options: Maquette.Options = {}): Promise<Maquette.Result> {
  const { token, lang, theme, subject, pictures, allow, signal, onProgress, onResult } = options;
  const frame = document.createElement("iframe");
  frame.src = page.href;
  frame.title = options.title ?? (lang?.startsWith("de") ? "Körper vermessen" : "Measure a body");
  frame.allow = "camera; accelerometer; gyroscope";
  let height = 480;
  const { minHeight } = element.style;
  const lay = (covers: boolean) => {
    const { style } = frame;
    style.cssText = "display: block; border: 0; width: 100%";
    style.height = `${height}px`;
    // Its room is kept, else the site would scroll to another place.
    element.style.minHeight = covers ? `${element.offsetHeight}px` : minHeight;
    if (covers) style.cssText = "position: fixed; inset: 0; z-index: 2147483647; border: 0; width: 100%; height: 100%";
  };
  lay(false);

  return new Promise((resolve, reject) => {
    let covers = false;
    let silence: ReturnType<typeof setTimeout> | undefined;
    const send = (message: Maquette.ToFrame) => frame.contentWindow?.postMessage(message, page.origin);
    const followed = () => element.dataset.theme as Maquette.Theme | undefined;
    const watching = new MutationObserver(() => send({ type: "maquette:theme", theme: followed() ?? theme ?? "system" }));
    const withToken = async (use: (found?: string) => void) => {
      try {
        use(await token?.());
      } catch (error) {
        reject(error);
      }
    };
    const hear = (event: MessageEvent) => {
      // A frame that the site took away says nothing more.
      if (!frame.isConnected) return forget();
      if (event.source !== frame.contentWindow || event.origin !== page.origin) return;
      const message = event.data as Maquette.FromFrame;
      switch (message.type) {
        case "maquette:ready":
          clearTimeout(silence);
          silence = undefined;
          frame.onload = null;
          watching.observe(element, { attributeFilter: ["data-theme"] });
          void withToken((found) => send({ type: "maquette:start", token: found, lang, theme: theme ?? followed(), subject, pictures, allow }));
          break;
        case "maquette:token-needed":
          if (!token) reject(failure("The service asks for a token: give measure() the option `token`.", { field: "token" }));
          else void withToken((found) => send({ type: "maquette:token", token: found! }));
          break;
        case "maquette:resize":
          // Until the camera is closed, it is the height at the window's width.
          if (covers) break;
          height = message.height;
          lay(covers);
          break;
        case "maquette:camera":
          covers = message.open;
          lay(covers);
          break;
        case "maquette:progress":
          onProgress?.({ stage: message.stage, share: message.share });
          break;
        case "maquette:result": {
          const { type: _, ...result } = message;
          onResult?.(result);
          resolve(result);
          break;
        }
        case "maquette:refused":
          reject(failure(message.reason, { field: message.field }));
          break;
        case "maquette:failed":
          reject(failure(message.problem.detail, { problem: message.problem }));
          break;
        case "maquette:cancelled":
          reject(failure("The visitor cancelled.", { name: "AbortError" }));
      }
    };
    const forget = () => {
      removeEventListener("message", hear);
      watching.disconnect();
      clearTimeout(silence);
    };
    const leave = () => {
      forget();
      frame.remove();
      reject(failure("The site cancelled.", { name: "AbortError" }));
    };
    if (signal?.aborted) return leave();
    signal?.addEventListener("abort", leave);
    frame.onload = () => {
      const refused = `${page.origin} did not show its page in a frame: name ${location.origin} in its MAQUETTE_EMBED_ORIGINS.`;
      silence ??= setTimeout(() => reject(failure(refused)), READY_WITHIN_MS);
    };
    addEventListener("message", hear);
    element.append(frame);
  });
}

Object.assign(window, { Maquette: { measure } satisfies typeof Maquette });
