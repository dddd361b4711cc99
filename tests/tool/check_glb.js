// SPDX-License-Identifier: MIT
// check_glb.js OSGGPUANIM FILE: converts the file to a .glb and passes it to Khronos's validator. Status 1: it has errors.
// NODE_PATH: the folder node_modules with the package gltf-validator.
const { execFileSync } = require('child_process');
const { mkdtempSync, readFileSync, rmSync } = require('fs');
const { tmpdir } = require('os');
const { join } = require('path');
const validator = require('gltf-validator');

const [tool, file] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'osggpuanimation-'));
const glb = join(folder, 'converted.glb');
(async () => {
    try {
        execFileSync(tool, ['convert', file, '-o', glb], { stdio: 'inherit' });
        const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(glb)), { maxIssues: 100 });
        for (const issue of issues.messages) console.log(issue.severity, issue.code, issue.message, issue.pointer);
        console.log(`${issues.numErrors} errors, ${issues.numWarnings} warnings`);
        process.exitCode = issues.numErrors > 0 ? 1 : 0;
    } finally {
        rmSync(folder, { recursive: true });
    }
})();
