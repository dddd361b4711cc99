// SPDX-License-Identifier: MIT
#include "PseudoLoader.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <new>

namespace osgGpuAnimation
{

PseudoLoader::ReadResult PseudoLoader::readNode(const std::string& fileName, const Options* options) const
{
    if (!acceptsExtension(osgDB::getLowerCaseFileExtension(fileName))) return ReadResult::FILE_NOT_HANDLED;
    try
    {
        return read(osgDB::getNameLessExtension(fileName), options);
    }
    catch (const std::bad_alloc&)
    {
        return ReadResult::INSUFFICIENT_MEMORY_TO_LOAD;
    }
}

PseudoLoader::ReadResult PseudoLoader::readModel(const std::string& modelFile, const Options* options,
                                                 const std::string& owner)
{
    ReadResult model = osgDB::Registry::instance()->readNode(modelFile, options);
    if (model.validNode()) return model;
    if (!model.message().empty()) return ReadResult(modelFile + ": " + model.message());
    const bool isMissing = model.status() == ReadResult::FILE_NOT_FOUND;
    return ReadResult("the " + owner + "'s model " + modelFile + (isMissing ? " does not exist" : " cannot be read"));
}

} // namespace osgGpuAnimation
