// The calls this page makes, one function each.
import type { ServiceIndex } from "./service_index";
import { jsonBody, request, requestJson } from "./client";
import type { CaptureCheck, CheckOfImage, Derivation, DerivationPage, DerivationRequest, DerivationResult, FitOfImage, FitOptions, FitResult, InitialPose, InitialPoseRequest, Job, JobPage, LabelledPerson, PeoplePage, PointsOfImage, PointsProposal, Scan, ScanOfImages, ScanOptions, ScanPage, ScanResult, UploadedImage } from "./types";

export function getIndex(): Promise<ServiceIndex> {
  return requestJson("/", { headers: { Accept: "application/json" } });
}

export function uploadImage(file: Blob, signal: AbortSignal): Promise<UploadedImage> {
  const form = new FormData();
  form.append("image", file, "picture");
  return requestJson("/v1/images", { method: "POST", body: form, signal });
}

export function initialPose(asked: InitialPoseRequest, signal: AbortSignal): Promise<InitialPose> {
  return requestJson("/v1/initial-poses", { ...jsonBody(asked), signal });
}

export function proposePoints(asked: PointsOfImage, signal: AbortSignal): Promise<PointsProposal> {
  return requestJson("/v1/points", { ...jsonBody(asked), signal });
}

export function checkCapture(asked: CheckOfImage, signal: AbortSignal): Promise<CaptureCheck> {
  return requestJson("/v1/checks", { ...jsonBody(asked), signal });
}

export function submitScan(asked: ScanOfImages): Promise<Scan> {
  return requestJson("/v1/scans", jsonBody(asked));
}

export function getScan(id: string): Promise<Scan> {
  return requestJson(`/v1/scans/${id}`);
}

export function getScanResult({ links }: Scan): Promise<ScanResult> {
  return requestJson(links.result ?? `${links.self}/result`);
}

export function getScanRequest({ links }: Scan): Promise<ScanOptions> {
  return requestJson(links.request);
}

export function cancelScan(id: string): Promise<Scan> {
  return requestJson(`/v1/scans/${id}/cancel`, { method: "POST" });
}

export async function eraseScan(id: string): Promise<void> {
  await request(`/v1/scans/${id}`, { method: "DELETE" });
}

export function submitFit(asked: FitOfImage): Promise<Job> {
  return requestJson("/v1/fits", jsonBody(asked));
}

export function getFit(id: string): Promise<Job> {
  return requestJson(`/v1/fits/${id}`);
}

export function getResult(job: Job): Promise<FitResult> {
  return requestJson(job.links.result ?? `/v1/fits/${job.id}/result`);
}

export function getRequest({ links }: Pick<Job | Scan, "links">): Promise<FitOptions> {
  return requestJson(links.request);
}

export function cancelFit(id: string): Promise<Job> {
  return requestJson(`/v1/fits/${id}/cancel`, { method: "POST" });
}

export async function eraseFit(id: string): Promise<void> {
  await request(`/v1/fits/${id}`, { method: "DELETE" });
}

export async function listDerivations({ links }: Job | Scan): Promise<readonly Derivation[]> {
  return (await requestJson<DerivationPage>(`${links.self}/derivations`)).derivations;
}

/** Ask for a derivation; `part` is the file it goes by, under the name of its form part. */
export function derive({ links }: Job | Scan, asked: DerivationRequest, part: { name: string; file: File } | null): Promise<Derivation> {
  const path = `${links.self}/derivations`;
  if (!part) return requestJson(path, jsonBody(asked));
  const form = new FormData();
  form.append("request", new Blob([JSON.stringify(asked)], { type: "application/json" }), "request.json");
  form.append(part.name, part.file, part.file.name);
  return requestJson(path, { method: "POST", body: form });
}

export function getDerivation(path: string): Promise<Derivation> {
  return requestJson(path);
}

export function getDerivationResult({ links }: Derivation): Promise<DerivationResult> {
  return requestJson(links.result ?? `${links.self}/result`);
}

export function retryDerivation({ links }: Derivation): Promise<Derivation> {
  return requestJson(`${links.self}/retry`, { method: "POST" });
}

export async function eraseDerivation({ links }: Derivation): Promise<void> {
  await request(links.self, { method: "DELETE" });
}

/** The picture of a fit or a scan as every browser shows it: a HEIC comes as a JPEG. */
export async function getPicture(path: string): Promise<Blob> {
  return (await request(path, { headers: { Accept: "image/png, image/webp, image/jpeg" } })).blob();
}

/** A file by its link: by fetch, not by an element's address, since a key may be needed. `onBytes` hears of each piece. */
export async function getFile(path: string, onBytes?: (count: number) => void): Promise<Blob> {
  const response = await request(path);
  if (!onBytes || !response.body) return response.blob();
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  const reader = response.body.getReader();
  for (let piece = await reader.read(); !piece.done; piece = await reader.read()) {
    pieces.push(piece.value);
    onBytes(piece.value.length);
  }
  return new Blob(pieces, { type: response.headers.get("Content-Type") ?? "" });
}

/** All people that have fits or scans, by their labels. */
export async function listPeople(): Promise<readonly LabelledPerson[]> {
  const pages = await allPages<PeoplePage>(`/v1/people?limit=${PAGE}`);
  return pages.flatMap(({ people }) => people);
}

/** All fits of a person, newest first. */
export async function listFits(label: string): Promise<readonly Job[]> {
  const pages = await allPages<JobPage>(`/v1/fits?limit=${PAGE}&label=${encodeURIComponent(label)}`);
  return pages.flatMap(({ jobs }) => jobs);
}

/** All scans of a person, newest first. */
export async function listScans(label: string): Promise<readonly Scan[]> {
  const pages = await allPages<ScanPage>(`/v1/scans?limit=${PAGE}&label=${encodeURIComponent(label)}`);
  return pages.flatMap(({ scans }) => scans);
}

const PAGE = 100;

async function allPages<Page extends { readonly next: string | null }>(first: string): Promise<readonly Page[]> {
  const pages: Page[] = [];
  for (let path: string | null = first; path !== null; path = pages.at(-1)!.next) pages.push(await requestJson<Page>(path));
  return pages;
}
