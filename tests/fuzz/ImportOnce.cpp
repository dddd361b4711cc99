// SPDX-License-Identifier: MIT
#include "fuzz/ImportOnce.h"

#include "gltf/Import.h"

#include <osg/Notify>

namespace osgGpuAnimation::gltf
{

void importOnce(const std::string& bytes, const std::string& fileName)
{
    osg::setNotifyLevel(osg::ALWAYS);
    ImportOptions options;
    options.maxDecodedBytes = std::size_t(16) << 20;
    options.maxElements = std::size_t(1) << 16;
    const Result<ImportedModel> model = importModel(bytes, fileName, options);
    if (model) model.value().root->getBound();
}

} // namespace osgGpuAnimation::gltf
