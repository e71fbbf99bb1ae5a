// How the fit went, for experts.
import type { FitResult, ViewResult } from "../api/types";
import { capitalised, decimal, degrees, measured, percent, seconds } from "../messages/figures";
import { messages } from "../messages";
import { viewTitles } from "../messages/viewNames";
import { plainName } from "../messages/words";
import { lensMm } from "./remarks";

export function ForExperts({ result }: { readonly result: FitResult }) {
  const { agreement, cues, energies, evaluations, stage_seconds, views } = result;
  const { result: words } = messages;
  const titles = viewTitles(views);
  return (
    <details class="section fold-section experts">
      <summary>
        <h2>{words.expert}</h2>
      </summary>
      <p class="fine">{words.foundBy[cues]}</p>
      {agreement !== null && <p class="fine">{words.agreement(percent(agreement, agreement < 0.01 ? 1 : 0))}</p>}
      {views.map((view, number) => (
        <>
          {views.length > 1 && <h3>{titles[number]}</h3>}
          <PictureFacts view={view} />
        </>
      ))}
      <dl class="facts">
        {Object.entries(energies).map(([name, value]) => (
          <>
            <dt>{capitalised(plainName(name))}</dt>
            <dd>{decimal(value, 1)}</dd>
          </>
        ))}
        <dt>{words.evaluations}</dt>
        <dd>{decimal(evaluations)}</dd>
        <dt>{words.time}</dt>
        <dd>{seconds(Object.values(stage_seconds).reduce((sum, each) => sum + each, 0), 1)}</dd>
      </dl>
    </details>
  );
}

/** How well the body covers the person, with which lens, in which light and of which skin. */
function PictureFacts({ view }: { view: ViewResult }) {
  const { result: words } = messages;
  const { light, reflectance } = view;
  return (
    <dl class="facts">
      <dt>{words.overlap}</dt>
      <dd>{percent(view.silhouette_overlap, 1)}</dd>
      <dt>{words.lens}</dt>
      <dd>{words.lensOf(measured(lensMm(view), "millimeter"), words.sources[view.focal_length_source])}</dd>
      {light && (
        <>
          <dt>{words.light}</dt>
          <dd>{lightWords(light)}</dd>
        </>
      )}
      {reflectance && (
        <>
          <dt>{words.skin}</dt>
          <dd>
            {words.skinOf(percent(reflectance.mean_albedo), percent(reflectance.mean_specularity))}; {words.ambient(decimal(reflectance.ambient, 2))}
          </dd>
        </>
      )}
    </dl>
  );
}

function lightWords(light: NonNullable<ViewResult["light"]>): string {
  const { result: words } = messages;
  const [azimuth, elevation, distance] = [light.azimuth_deg ?? 0, light.elevation_deg ?? 0, light.distance_m ?? null];
  const side = azimuth > 0 ? words.fromRight : words.fromLeft;
  const height = elevation > 0 ? words.fromAbove : words.fromBelow;
  const away = distance === null ? words.lightFar : words.lightAway(measured(distance, "meter", 1));
  return [side(degrees(Math.abs(azimuth))), height(degrees(Math.abs(elevation))), away].join(", ");
}
