// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"

#include "assimp/FbxConversion.h"
#include "assimp/SceneConversion.h"
#include "gltf/file/Uri.h"

#include <osgGpuAnimation/math/detail/RegularFile.h>

#include <assimp/config.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <osgDB/FileNameUtils>

#include <filesystem>
#include <system_error>
#include <utility>

namespace osgGpuAnimation::assimp
{

namespace
{

/// Regular files of a folder, to read. Assimp 6 has a DefaultIOSystem that is final.
class FolderFiles : public Assimp::IOSystem
{
public:
    FolderFiles(const std::string& fileName, bool allowOutsideFiles) : _allowOutsideFiles(allowOutsideFiles)
    {
        std::error_code failure;
        _folder = std::filesystem::canonical(fileName, failure).parent_path();
    }

    bool Exists(const char* file) const override
    {
        std::error_code failure;
        const std::filesystem::path path = std::filesystem::canonical(file, failure);
        if (failure || !std::filesystem::is_regular_file(path, failure)) return false;
        return (_allowOutsideFiles || gltf::isBelow(path, _folder)) &&
               std::filesystem::file_size(path, failure) <= maxFileBytes;
    }

    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        return Exists(file) && mode[0] == 'r' ? _files.Open(file, mode) : nullptr;
    }

    void Close(Assimp::IOStream* stream) override { _files.Close(stream); }
    char getOsSeparator() const override { return _files.getOsSeparator(); }
    bool ComparePaths(const char* one, const char* second) const override { return _files.ComparePaths(one, second); }

private:
    Assimp::DefaultIOSystem _files;
    std::filesystem::path _folder;
    bool _allowOutsideFiles;
};

Error unreadable(const Assimp::Importer& importer)
{
    const std::string text = importer.GetErrorString();
    return {"Assimp cannot read it: " + gltf::printable(text.substr(0, text.find('\n')), 300)};
}

constexpr unsigned int steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_LimitBoneWeights |
                               aiProcess_JoinIdenticalVertices | aiProcess_GenSmoothNormals | aiProcess_GlobalScale |
                               aiProcess_FindInvalidData | aiProcess_ValidateDataStructure;

Result<const aiScene*> readFbx(Assimp::Importer& importer, const std::string& fileName, gltf::Report& report)
{
    Result<std::string> content = RegularFile::readWhole(fileName, maxFileBytes);
    if (!content) return content.error();
    const Result<fbx::Scene> fbx = fbx::Scene::read(std::move(content).value());
    if (!fbx) return fbx.error();
    // Pivots, which would become chains of nodes with names of Assimp's own, are completeFbx()'s.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const std::string& bytes = fbx.value().bytesForAssimp;
    if (!importer.ReadFileFromMemory(bytes.data(), bytes.size(), steps, "fbx")) return unreadable(importer);
    aiScene& scene = const_cast<aiScene&>(*importer.GetScene()); // on the heap, of the importer
    completeFbx(scene, fbx.value(), report);
    return &scene;
}

} // namespace

bool isFormat(const std::string& extension)
{
    return !extension.empty() && Assimp::Importer().IsExtensionSupported(extension);
}

Result<const aiScene*> readScene(Assimp::Importer& importer, const std::string& fileName,
                                 const gltf::ImportOptions& options, gltf::Report& report)
{
    std::error_code failure;
    if (std::filesystem::file_size(fileName, failure) > maxFileBytes && !failure)
        return Error{"the file has more than " + std::to_string(maxFileBytes) + " bytes"};
    importer.SetIOHandler(new FolderFiles(fileName, options.allowOutsideFiles)); // which the importer deletes
    if (osgDB::getLowerCaseFileExtension(fileName) == "fbx") return readFbx(importer, fileName, report);
    const aiScene* const scene = importer.ReadFile(fileName, steps);
    if (!scene) return unreadable(importer);
    return scene;
}

Result<std::string> readAsGlb(const std::string& fileName, const gltf::ImportOptions& options, gltf::Report& report)
{
    Assimp::Importer importer;
    const Result<const aiScene*> scene = readScene(importer, fileName, options, report);
    return scene ? glbOf(*scene.value(), fileName, options, report) : scene.error();
}

} // namespace osgGpuAnimation::assimp
