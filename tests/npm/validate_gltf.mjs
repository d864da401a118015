// Runs the Khronos glTF validator.
//   node validate_gltf.mjs FILE...            prints errors and warnings of each file
//   node validate_gltf.mjs --compare IN OUT   fails if OUT has a kind of issue that IN has not
// Exit code: 0 good, 1 issues, 2 cannot run.
import {readFile} from 'node:fs/promises';
import {basename, dirname, join} from 'node:path';

let validator;
try {
  validator = (await import('gltf-validator')).default;
} catch {
  console.error('gltf-validator is not installed: run `npm install` in tests/npm');
  process.exit(2);
}

const kWarning = 1;  // severities: 0 error, 1 warning, 2 information, 3 hint

async function validate(file) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: basename(file),
    maxIssues: 0,
    externalResourceFunction: async (uri) =>
        new Uint8Array(await readFile(join(dirname(file), decodeURIComponent(uri)))),
  });
  const codes = new Map();
  for (const message of report.issues.messages) {
    if (message.severity > kWarning) continue;
    const entry = codes.get(message.code) ?? {severity: message.severity, count: 0, first: message};
    ++entry.count;
    codes.set(message.code, entry);
  }
  return {errors: report.issues.numErrors, warnings: report.issues.numWarnings, codes};
}

function describe(file, result) {
  console.log(`${file}: ${result.errors} errors, ${result.warnings} warnings`);
  for (const [code, {severity, count, first}] of result.codes)
    console.log(`  ${severity === 0 ? 'error' : 'warning'} ${code} x${count}: ${first.message}` +
                (first.pointer ? ` (${first.pointer})` : ''));
}

const args = process.argv.slice(2);
let bad = false;
if (args[0] === '--compare') {
  for (let i = 1; i + 1 < args.length; i += 2) {
    const [before, after] = [await validate(args[i]), await validate(args[i + 1])];
    describe(args[i + 1], after);
    for (const code of after.codes.keys())
      if (!before.codes.has(code)) {
        console.log(`  NEW: ${code} is not in ${args[i]}`);
        bad = true;
      }
  }
} else {
  for (const file of args) {
    const result = await validate(file);
    describe(file, result);
    bad ||= result.errors > 0;
  }
}
process.exit(bad ? 1 : 0);
