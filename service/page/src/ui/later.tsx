// What is loaded once it is asked for.
import type { ComponentChildren, ComponentType } from "preact";
import { useEffect, useState } from "preact/hooks";

const TRY_AGAIN_MS = 2000;

const WAITING_SCREEN = <main class="waiting" aria-busy="true" />;

/** Meanwhile `waiting` is shown; a line that fails is tried again. */
export function later<Props extends object>(
  load: () => Promise<ComponentType<Props>>,
  waiting: ComponentChildren = WAITING_SCREEN,
): ComponentType<Props> {
  // Once loaded it is there at once: no empty screen on the way back to it.
  let loaded: ComponentType<Props> | null = null;
  return function Later(props: Props) {
    const [View, setView] = useState(() => loaded);
    useEffect(() => {
      if (View) return undefined;
      let timer = 0;
      const attempt = () =>
        load().then(
          (view) => {
            loaded = view;
            setView(() => view);
          },
          () => (timer = window.setTimeout(() => void attempt(), TRY_AGAIN_MS)),
        );
      void attempt();
      return () => clearTimeout(timer);
    }, [View]);
    return View ? <View {...props} /> : <>{waiting}</>;
  };
}
